//! The list of networks. A new one is a file and a line here.

use serde::{Deserialize, Deserializer, Serialize};

use crate::architecture::{Architecture, ConfigError};

macro_rules! networks {
    ($($(#[$doc:meta])* $variant:ident($config:ty) = $kind:literal),+ $(,)?) => {
        /// A network by its kind: `kind = "cfc"` and that network's own fields.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        #[serde(tag = "kind")]
        pub enum NetworkConfig {
            $($(#[$doc])* #[serde(rename = $kind)] $variant($config)),+
        }

        impl NetworkConfig {
            /// The kinds that can be asked for.
            pub const KINDS: &'static [&'static str] = &[$($kind),+];

            /// Each network with its default sizes.
            pub fn all() -> Vec<Self> {
                vec![$(Self::$variant(Default::default())),+]
            }

            /// The network behind the configuration.
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
        }
    };
}

networks! {
    /// Multilayer perceptron.
    Mlp(crate::mlp::MlpConfig) = "mlp",
    /// Gated recurrent unit.
    Gru(crate::gru::GruConfig) = "gru",
    /// Closed-form continuous-time network.
    Cfc(crate::cfc::CfcConfig) = "cfc",
}

impl NetworkConfig {
    /// The name under which files ask for it.
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
}

impl Default for NetworkConfig {
    fn default() -> Self {
        Self::Cfc(crate::cfc::CfcConfig::default())
    }
}
