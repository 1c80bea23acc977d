//! Criteria of the search by name, so that a command line can change one.

use acm_trace::search::criteria::Criteria;

/// A value of a criterion.
trait Value: Sized {
    /// Parses a value.
    fn read(text: &str) -> Option<Self>;
}

impl Value for f64 {
    fn read(text: &str) -> Option<Self> {
        text.parse().ok().filter(|value: &f64| value.is_finite() && *value >= 0.0)
    }
}

impl Value for usize {
    fn read(text: &str) -> Option<Self> {
        text.parse().ok()
    }
}

macro_rules! criteria {
    ($($name:ident),+ $(,)?) => {
        /// Names of the criteria, in the order of the fields.
        pub const NAMES: &[&str] = &[$(stringify!($name)),+];

        fn assign(criteria: &mut Criteria, name: &str, value: &str) -> Option<()> {
            match name {
                $(stringify!($name) => criteria.$name = Value::read(value)?,)+
                _ => return None,
            }
            Some(())
        }
    };
}

criteria!(
    max_effects,
    price,
    generic,
    context,
    rare,
    parameter,
    minor,
    negligible,
    level,
    few,
    clear,
    family_wise,
    surrogates,
    beam,
    behind,
    cancelled,
    refined,
    degree_share,
    resamples,
    sure,
    likely,
    taken_back,
    followed,
);

/// Changes a criterion: `edit` is `NAME=VALUE`.
///
/// # Errors
/// A name that there is not, with those that there are; a value that is none. In words.
pub fn set(criteria: &mut Criteria, edit: &str) -> Result<(), String> {
    let (name, value) = edit.split_once('=').ok_or_else(|| format!("{edit:?} is not NAME=VALUE"))?;
    let (name, value) = (name.trim(), value.trim());
    if !NAMES.contains(&name) {
        return Err(format!("there is no criterion {name:?}; known: {}", NAMES.join(" ")));
    }
    assign(criteria, name, value)
        .ok_or_else(|| format!("{value:?} is no value of {name}: a number that is not negative"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: how the struct writes itself.
    #[test]
    fn every_field_has_its_name() {
        let written = format!("{:?}", Criteria::default());
        let fields: Vec<&str> = written.split([' ', '{']).filter_map(|word| word.strip_suffix(':')).collect();
        assert_eq!(fields, NAMES);
    }

    #[test]
    fn a_criterion_is_changed_and_an_unknown_one_refused() {
        let mut criteria = Criteria::default();
        set(&mut criteria, "price=0.05").expect("a price");
        set(&mut criteria, "beam=3").expect("a beam");
        assert_eq!(criteria, Criteria { price: 0.05, beam: 3, ..Criteria::default() });
        let refused = ["prize=0.05", "price=cheap", "price=-1", "beam=1.5", "price"];
        let errors = refused.map(|edit| set(&mut criteria, edit).expect_err("it is refused"));
        assert!(errors[0].contains("prize") && errors[0].contains("level"), "{}", errors[0]);
        assert_eq!(criteria, Criteria { price: 0.05, beam: 3, ..Criteria::default() }, "nothing else changed");
    }
}
