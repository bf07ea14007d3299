"""Verified frames to files that people look at: PNG, animated PNG, GIF, MP4.

Every file is written beside its name and renamed when it is complete, so that a failure leaves what was there before.
The animations are written frame by frame: memory holds one frame of a recording of any length.
"""
