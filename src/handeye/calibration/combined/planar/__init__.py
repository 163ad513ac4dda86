"""The planar robot as the combined calibrator sees it."""
