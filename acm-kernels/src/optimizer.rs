//! Steps of optimizers over slices of parameters, as `torch.optim` takes them.
//!
//! | function | does |
//! | --- | --- |
//! | [`adam::step`] | Adam and AdamW |
//! | [`rmsprop::step`] | RMSprop without momentum |
//! | [`clip::clip`] | limits the norm of the gradient |
//!
//! Their state is [`moments::Moments`].

pub mod adam;
pub mod clip;
pub mod moments;
pub mod rmsprop;

#[cfg(test)]
mod tests {
    use pulp::Arch;

    use super::moments::FAINT_SQUARE;
    use crate::vectors::level::Level;

    /// Returns every set of vector instructions that this processor has.
    pub fn architectures() -> Vec<Arch> {
        Level::available().filter_map(Level::arch).chain([Arch::new()]).collect()
    }

    /// Oracle: 1 plus half of its last digit rounds to 1; so does ε with what is forgotten, and not with ten thousand times that.
    #[test]
    fn a_forgotten_square_changes_no_digit() {
        let with = |square: f32| square.sqrt() * 32.0 + 1e-8f32;
        assert_eq!(with(FAINT_SQUARE), 1e-8);
        assert_ne!(with(1e4 * FAINT_SQUARE), 1e-8);
    }
}
