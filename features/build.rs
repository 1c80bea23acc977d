//! Nothing to build: a build script must exist for build-dependencies, whose features are unified too, to count.
fn main() {}
