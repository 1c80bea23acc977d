//! Recordings of a robot: trials, checks, windows, folds, scalers, and the synthetic flight campaign.
