"""Command palette, shortcuts, tour, licences."""
