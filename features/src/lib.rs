//! An empty crate: its manifest unifies features of dependencies.
