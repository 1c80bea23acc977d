//! Matching of names to causes, each to one at most.
//!
//! A largest matching by augmenting paths: Kuhn (1955), Naval Research Logistics Quarterly 2.

/// Returns the cause of each name: as many as can be. Names come in order, and each takes the first cause that it can.
pub fn matching(names: usize, causes: usize, stands: impl Fn(usize, usize) -> bool) -> Vec<Option<usize>> {
    let mut taken: Vec<Option<usize>> = vec![None; causes];
    for name in 0..names {
        place(name, &stands, &mut taken, &mut vec![false; causes]);
    }
    (0..names).map(|name| taken.iter().position(|holder| *holder == Some(name))).collect()
}

/// Assigns a cause to a name, moving others where it has to.
fn place(name: usize, stands: &impl Fn(usize, usize) -> bool, taken: &mut [Option<usize>], seen: &mut [bool]) -> bool {
    for cause in 0..taken.len() {
        if seen[cause] || !stands(name, cause) {
            continue;
        }
        seen[cause] = true;
        if taken[cause].is_none_or(|holder| place(holder, stands, taken, seen)) {
            taken[cause] = Some(name);
            return true;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. The first name takes the first cause, and gives it up for a name that has no other.
    #[test]
    fn a_name_gives_way_to_one_that_has_no_choice() {
        let table = [[true, true, false], [true, false, false], [false, false, false]];
        assert_eq!(matching(3, 3, |name, cause| table[name][cause]), [Some(1), Some(0), None]);
        assert_eq!(matching(2, 1, |_, _| true), [Some(0), None]);
        assert!(matching(0, 4, |_, _| true).is_empty());
    }
}
