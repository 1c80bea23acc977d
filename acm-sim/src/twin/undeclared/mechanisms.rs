//! Mechanisms that nobody declares, by what they act on.

pub mod maps;
pub mod memory;
pub mod outside;
pub mod pushes;
pub mod seen;
