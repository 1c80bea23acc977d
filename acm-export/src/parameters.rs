//! The network's parameters by the names of torch and ncps ([`acm_kernels::ParameterShape`]).

use acm_kernels::Shape;

/// One tensor.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Name in torch or ncps.
    pub name: String,
    /// Length of each axis.
    pub shape: Vec<usize>,
    /// Values row by row.
    pub values: Vec<f32>,
}

/// Returns the parameters of a network from one row of `weights`, in the order of [`acm_stream::Parts::weights`].
///
/// # Panics
/// If there are fewer weights than the shape has.
pub fn parameters(shape: &Shape, weights: &[f32]) -> Vec<Parameter> {
    let mut rest = weights;
    let mut next = |parameter: acm_kernels::ParameterShape| {
        let (values, after) = rest.split_at(parameter.axes.iter().product());
        rest = after;
        Parameter { name: parameter.name, shape: parameter.axes, values: values.to_vec() }
    };
    shape.parameters().into_iter().map(&mut next).collect()
}
