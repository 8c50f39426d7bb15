"""The exercises of the lessons: one module of checks for each lesson, and what they share."""
