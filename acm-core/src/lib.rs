//! Physics of a continuum arm: strain, shape, tip model and its calibration.
