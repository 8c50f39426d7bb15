"""Files that travel with the program: trained policies, pictures, lessons."""
