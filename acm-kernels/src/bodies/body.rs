//! The list of bodies. A new one is a file and a line in each match.

use pulp::Simd;

use crate::bodies::cfc::Cfc;
use crate::bodies::gru::Gru;
use crate::bodies::mlp::Mlp;
use crate::bodies::network::{Network, Source, Weights};
use crate::plan::{Gradients, Plan};
use crate::shape::{Body, Shape};
use crate::vectors::gradient::Stretches;
use crate::vectors::row::Row;

macro_rules! bodies {
    ($($kind:ident),+) => {
        /// A body of any kind.
        #[derive(Clone, Debug)]
        pub(crate) enum AnyBody {
            $($kind($kind)),+
        }

        /// Activations of one shard for a body of any kind.
        pub(crate) enum AnyTapes {
            $($kind(<$kind as Network>::Tapes)),+
        }

        impl AnyBody {
            /// Takes its parameters from the plan.
            pub fn new(shape: &Shape, plan: &mut Plan) -> Self {
                match &shape.body {
                    $(Body::$kind(body) => Self::$kind($kind::new(body.clone(), shape.inputs, plan))),+
                }
            }
        }

        impl Network for AnyBody {
            type Tapes = AnyTapes;

            fn tapes(&self) -> AnyTapes {
                match self { $(Self::$kind(body) => AnyTapes::$kind(body.tapes())),+ }
            }

            fn reserve(&self, tapes: &mut AnyTapes, steps: usize, train: bool) {
                match (self, tapes) {
                    $((Self::$kind(body), AnyTapes::$kind(tapes)) => body.reserve(tapes, steps, train),)+
                    _ => other_kernel(),
                }
            }

            #[inline(always)]
            fn forward<S: Simd, const TRAIN: bool>(
                &self,
                s: S,
                weights: Weights,
                tapes: &mut AnyTapes,
                steps: usize,
                source: &impl Source,
                each: impl FnMut(usize, &[Row]),
            ) {
                match (self, tapes) {
                    $((Self::$kind(body), AnyTapes::$kind(tapes)) => {
                        body.forward::<S, TRAIN>(s, weights, tapes, steps, source, each)
                    })+
                    _ => other_kernel(),
                }
            }

            #[inline(always)]
            fn backward<S: Simd>(
                &self,
                s: S,
                weights: Weights,
                tapes: &mut AnyTapes,
                steps: usize,
                last: impl FnMut(usize, &mut [Row]),
                each: impl FnMut(usize, &mut [Row]),
                gradients: &mut Gradients,
            ) {
                match (self, tapes) {
                    $((Self::$kind(body), AnyTapes::$kind(tapes)) => {
                        body.backward(s, weights, tapes, steps, last, each, gradients)
                    })+
                    _ => other_kernel(),
                }
            }

            #[inline(always)]
            fn by_inputs<S: Simd>(
                &self,
                s: S,
                weights: Weights,
                tapes: &AnyTapes,
                steps: usize,
                each: impl FnMut(usize, &mut [Row]),
                to: impl FnMut(usize, &[Row]),
            ) {
                match (self, tapes) {
                    $((Self::$kind(body), AnyTapes::$kind(tapes)) => {
                        body.by_inputs(s, weights, tapes, steps, each, to)
                    })+
                    _ => other_kernel(),
                }
            }

            fn by_state<'a>(&self, tapes: &'a AnyTapes, layer: usize) -> &'a [Row] {
                match (self, tapes) {
                    $((Self::$kind(body), AnyTapes::$kind(tapes)) => body.by_state(tapes, layer),)+
                    _ => other_kernel(),
                }
            }

            fn last_state<'a>(&self, tapes: &'a AnyTapes, layer: usize, steps: usize) -> &'a [Row] {
                match (self, tapes) {
                    $((Self::$kind(body), AnyTapes::$kind(tapes)) => body.last_state(tapes, layer, steps),)+
                    _ => other_kernel(),
                }
            }

            fn features<'a>(&self, tapes: &'a AnyTapes, step: usize) -> Stretches<'a> {
                match (self, tapes) {
                    $((Self::$kind(body), AnyTapes::$kind(tapes)) => body.features(tapes, step),)+
                    _ => other_kernel(),
                }
            }
        }
    };
}

bodies!(Cfc, Gru, Mlp);

fn other_kernel() -> ! {
    panic!("the workspace was made by a kernel of another kind")
}
