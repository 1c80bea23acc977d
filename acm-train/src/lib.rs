//! Learning what the nominal model misses: experiment files, training, folds, seeds, checkpoints, run records.
