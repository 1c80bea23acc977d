//! Networks over irregularly sampled sequences: MLP, GRU and CfC.
