//! Vector instructions: which there are, elementwise functions, products and sums on them.

pub mod functions;
pub mod gradient;
pub mod lanes;
pub mod level;
pub mod product;
pub mod row;
