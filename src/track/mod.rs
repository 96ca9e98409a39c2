//! Tracking: one frame after the other from features through search to pose and confidence.
