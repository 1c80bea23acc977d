//! All parameters of a module as one row of numbers, in torch's order and layout, and back.
//!
//! A module lists its parameters in the order of its fields, which is torch's. Their layout is torch's too, but for the
//! weight of burn's [`Linear`](burn::nn::Linear): [inputs, outputs] here, [outputs, inputs] there.

use burn::module::{Module, ModuleMapper, ModuleVisitor, Param};
use burn::tensor::{DType, Device, Gradients, Tensor, TensorData};

use crate::parameters::first_values::transposed;

/// One trainable tensor: its name and shape in torch.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name in torch's `named_parameters`.
    pub name: String,
    /// Shape in torch: one or two axes.
    pub shape: Vec<usize>,
}

impl Parameter {
    /// Returns the number of values.
    pub fn len(&self) -> usize {
        self.shape.iter().product()
    }

    /// Returns whether there are no values.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Position of a visitor: the names on the way, and the kind of the container of each.
#[derive(Default)]
struct Path(Vec<(String, String)>);

impl Path {
    fn enter(&mut self, name: &str, container: &str) {
        self.0.push((name.to_owned(), container.to_owned()));
    }

    fn exit(&mut self) {
        self.0.pop();
    }

    /// Returns whether burn holds the tensor at this position, of `axes`, as torch's transposed.
    fn is_turned(&self, axes: usize) -> bool {
        axes == 2 && self.0.last().is_some_and(|(_, container)| container == "Struct:Linear")
    }

    fn name(&self) -> String {
        let kept =
            self.0.iter().filter(|(_, container)| !container.starts_with("Enum:")).map(|(name, _)| name.as_str());
        kept.collect::<Vec<_>>().join(".")
    }
}

/// Returns the name of a parameter in torch or ncps, from a module's path: `backbone.1.weight` is `backbone.2.weight`
/// there, where activations are numbered too, and `layers.0.weight_ih` is `weight_ih_l0`.
pub(crate) fn torch_name(path: &str) -> String {
    let mut parts: Vec<String> = path.split('.').map(str::to_owned).collect();
    let Some(tail) = parts.len().checked_sub(3) else { return path.to_owned() };
    if let (Ok(layer), group) = (parts[tail + 1].parse::<usize>(), parts[tail].as_str()) {
        let own = parts[tail + 2].as_str();
        if group == "backbone" {
            parts[tail + 1] = (2 * layer).to_string();
        } else if group == "layers" && ["weight_ih", "weight_hh", "bias_ih", "bias_hh"].contains(&own) {
            let name = format!("{own}_l{layer}");
            parts.truncate(tail);
            parts.push(name);
        }
    }
    parts.join(".")
}

/// Returns the parameters in one row, `[1,P]`, tracked as they are. None where a parameter has changed since the module
/// was built: of another precision, quantized, or adapted.
pub(crate) fn row(module: &impl Module) -> Option<Tensor<2>> {
    let mut visitor = Row { path: Path::default(), parts: Some(Vec::new()) };
    module.visit(&mut visitor);
    visitor.parts.filter(|parts| !parts.is_empty()).map(|parts| Tensor::cat(parts, 1))
}

struct Row {
    path: Path,
    parts: Option<Vec<Tensor<2>>>,
}

impl ModuleVisitor for Row {
    fn enter_module(&mut self, name: &str, container: &str) {
        self.path.enter(name, container);
        if container == "Reparameterization" {
            self.parts = None;
        }
    }

    fn exit_module(&mut self, _: &str, _: &str) {
        self.path.exit();
    }

    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        let tensor = param.val();
        if tensor.dtype() != DType::F32 {
            self.parts = None;
        }
        if let Some(parts) = &mut self.parts {
            let count = tensor.shape().num_elements();
            let tensor = if self.path.is_turned(D) { tensor.swap_dims(0, 1) } else { tensor };
            parts.push(tensor.reshape([1, count]));
        }
    }
}

/// Returns the names and shapes of the parameters in torch.
pub(crate) fn parameters(module: &impl Module) -> Vec<Parameter> {
    let mut visitor = Names::default();
    module.visit(&mut visitor);
    visitor.all
}

#[derive(Default)]
struct Names {
    path: Path,
    all: Vec<Parameter>,
}

impl ModuleVisitor for Names {
    fn enter_module(&mut self, name: &str, container: &str) {
        self.path.enter(name, container);
    }

    fn exit_module(&mut self, _: &str, _: &str) {
        self.path.exit();
    }

    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        let mut shape = param.lazy_shape().to_vec();
        if self.path.is_turned(D) {
            shape.reverse();
        }
        self.all.push(Parameter { name: torch_name(&self.path.name()), shape });
    }
}

/// Returns the gradient of a loss in the order of [`row`]; zero where the loss does not depend on a parameter.
pub(crate) fn gradient(module: &impl Module, gradients: &mut Gradients) -> Vec<f32> {
    let mut visitor = Slopes { path: Path::default(), gradients, all: Vec::new() };
    module.visit(&mut visitor);
    visitor.all
}

struct Slopes<'a> {
    path: Path,
    gradients: &'a mut Gradients,
    all: Vec<f32>,
}

impl ModuleVisitor for Slopes<'_> {
    fn enter_module(&mut self, name: &str, container: &str) {
        self.path.enter(name, container);
    }

    fn exit_module(&mut self, _: &str, _: &str) {
        self.path.exit();
    }

    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        let tensor = param.val();
        let Some(gradient) = tensor.grad_remove(self.gradients) else {
            return self.all.resize(self.all.len() + tensor.shape().num_elements(), 0.0);
        };
        let gradient = if self.path.is_turned(D) { gradient.swap_dims(0, 1) } else { gradient };
        self.all.extend(numbers(gradient));
    }
}

/// Returns the module with other values, in the order of [`row`], on a device; tracked where the device has autodiff.
///
/// # Panics
/// If there is not one value for each.
pub(crate) fn with_values<M: Module>(module: M, values: &[f32], device: &Device) -> M {
    let mut mapper = Put { path: Path::default(), rest: values, device };
    let module = module.map(&mut mapper);
    assert!(mapper.rest.is_empty(), "one value for each parameter");
    module
}

struct Put<'a> {
    path: Path,
    rest: &'a [f32],
    device: &'a Device,
}

impl ModuleMapper for Put<'_> {
    fn enter_module(&mut self, name: &str, container: &str) {
        self.path.enter(name, container);
    }

    fn exit_module(&mut self, _: &str, _: &str) {
        self.path.exit();
    }

    fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
        let (id, old, mapper) = param.consume();
        let shape = old.shape();
        let (own, rest) = self.rest.split_at(shape.num_elements());
        self.rest = rest;
        let own = if self.path.is_turned(D) { transposed(own, shape[0]) } else { own.to_vec() };
        let tensor = Tensor::from_data(TensorData::new(own, shape), self.device);
        let tensor = if self.device.is_autodiff() { tensor.require_grad() } else { tensor };
        Param::from_mapped_value(id, tensor, mapper)
    }
}

/// Returns a tensor's values, row by row.
pub(crate) fn numbers<const D: usize>(tensor: Tensor<D>) -> Vec<f32> {
    tensor.into_data().try_to_vec().expect("networks are f32 by construction")
}

#[cfg(test)]
mod tests {
    use super::torch_name;

    #[test]
    fn names_are_those_of_torch() {
        assert_eq!(torch_name("backbone.1.weight"), "backbone.2.weight");
        assert_eq!(torch_name("mine.cfc.backbone.3.bias"), "mine.cfc.backbone.6.bias");
        assert_eq!(torch_name("layers.1.weight_hh"), "weight_hh_l1");
        assert_eq!(torch_name("mine.gru.layers.0.bias_ih"), "mine.gru.bias_ih_l0");
        for same in ["layers.1.weight", "head.bias", "A", "ff1.weight"] {
            assert_eq!(torch_name(same), same);
        }
    }
}
