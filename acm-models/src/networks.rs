//! The list of networks. A new one is a file and a line here.

use serde::{Deserialize, Deserializer, Serialize};

use acm_kernels::{Body, Keep, Kernel, Shape};
use burn::module::Module;
use burn::tensor::Tensor;

use crate::architecture::{Architecture, ConfigError};
use crate::parameters::first_values::FirstValues;
use crate::pass::{Fused, Reference};
use crate::steps::Steps;

macro_rules! networks {
    ($($(#[$doc:meta])* $variant:ident($config:ty, $module:ty) = $kind:literal),+ $(,)?) => {
        /// A network by its kind: `kind = "cfc"` and that network's own fields.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        #[serde(tag = "kind")]
        pub enum NetworkConfig {
            $($(#[$doc])* #[serde(rename = $kind)] $variant($config)),+
        }

        impl NetworkConfig {
            /// Kinds of networks.
            pub const KINDS: &'static [&'static str] = &[$($kind),+];

            /// Returns each network with its default sizes.
            pub fn all() -> Vec<Self> {
                vec![$(Self::$variant(Default::default())),+]
            }

            /// Returns the sizes behind the configuration.
            pub fn architecture(&self) -> &dyn Architecture {
                match self { $(Self::$variant(config) => config),+ }
            }

            /// Reads the fields of a network whose kind is already known.
            ///
            /// Where an error should point at the line and column of a field, read `kind` first and
            /// call this on the other fields: serde's own tagged reading has to copy the table
            /// before it knows the kind, and the places are lost. `None` if there is no such kind.
            pub fn decode<'de, D: Deserializer<'de>>(
                kind: &str,
                fields: D,
            ) -> Option<Result<Self, D::Error>> {
                match kind {
                    $($kind => Some(<$config>::deserialize(fields).map(Self::$variant)),)+
                    _ => None,
                }
            }

            /// Returns the network without its linear layer.
            pub(crate) fn build(&self, inputs: usize, first: &mut FirstValues) -> AnyBody {
                match self {
                    $(Self::$variant(config) => {
                        let mut config = config.clone();
                        config.inputs = inputs;
                        AnyBody::$variant(config.build(first))
                    })+
                }
            }
        }

        /// A network of any kind, without the linear layer over it.
        #[derive(Module, Debug)]
        pub enum AnyBody {
            $($(#[$doc])* $variant($module)),+
        }

        impl Reference for AnyBody {
            fn fused(&self) -> &Fused {
                match self { $(Self::$variant(body) => body.fused()),+ }
            }

            fn state_widths(&self) -> Vec<usize> {
                match self { $(Self::$variant(body) => body.state_widths()),+ }
            }

            fn run(&self, steps: &Steps, state: Vec<Tensor<2>>, keep: Keep) -> (Tensor<3>, Vec<Tensor<2>>) {
                match self { $(Self::$variant(body) => body.run(steps, state, keep)),+ }
            }
        }
    };
}

networks! {
    /// Multilayer perceptron.
    Mlp(crate::mlp::MlpConfig, crate::mlp::Mlp) = "mlp",
    /// Gated recurrent unit.
    Gru(crate::gru::GruConfig, crate::gru::Gru) = "gru",
    /// Closed-form continuous-time network.
    Cfc(crate::cfc::CfcConfig, crate::cfc::Cfc) = "cfc",
}

impl NetworkConfig {
    /// Returns the name under which files ask for it.
    pub fn kind(&self) -> &'static str {
        self.architecture().kind()
    }

    /// Refuses sizes that cannot be built.
    ///
    /// # Errors
    /// Names the field, its value and what to write instead.
    pub fn validate(&self) -> Result<(), ConfigError> {
        self.architecture().validate()
    }

    /// Returns the shape of the network for `inputs` channels and `outputs` predictions.
    pub fn shape(&self, inputs: usize, outputs: usize) -> Shape {
        Shape { body: self.architecture().body(), inputs, outputs }
    }

    /// Returns the number of trainable values without those of the linear layer, for `inputs` channels; zero if the
    /// network cannot be built. Nothing is allocated.
    pub fn parameter_count(&self, inputs: usize) -> usize {
        Kernel::without_head(&self.architecture().body(), inputs).map_or(0, |kernel| kernel.parameters())
    }

    /// Returns whether the time between two steps is an input of the network.
    pub fn reads_elapsed(&self) -> bool {
        matches!(self.architecture().body(), Body::Cfc(_))
    }
}

impl Default for NetworkConfig {
    fn default() -> Self {
        Self::Cfc(crate::cfc::CfcConfig::default())
    }
}
