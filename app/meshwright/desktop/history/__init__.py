"""History list, timeline, score curve, playback and export."""
