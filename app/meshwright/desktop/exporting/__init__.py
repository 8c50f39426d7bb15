"""What the exports of the window share: thread, bar, file name, and the frame of the dialog."""
