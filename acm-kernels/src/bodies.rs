//! The networks: perceptron, gated recurrent unit, closed-form continuous-time network, and what they are made of.

pub mod body;
pub mod cell;
pub mod cfc;
pub mod gru;
pub mod layer;
pub mod mlp;
pub mod network;
