//! The most similar known name.
//!
//! Distance: letters that must be put in, left out, replaced or exchanged with their neighbour (optimal string alignment).

/// Longer words are no slips of the pen.
const LONGEST: usize = 60;

/// The nearest of `known`, if a third of the letters or fewer differ; of one or two letters, none.
pub fn meant<'a>(written: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let letters: Vec<char> = written.to_lowercase().chars().take(LONGEST + 1).collect();
    let near =
        known.into_iter().map(|name| (distance(&letters, &name.to_lowercase().chars().collect::<Vec<_>>()), name));
    let (distance, name) = near.min_by_key(|(distance, _)| *distance)?;
    (letters.len() <= LONGEST && distance <= (letters.len() / 3).max(usize::from(letters.len() > 2))).then_some(name)
}

fn distance(a: &[char], b: &[char]) -> usize {
    let (mut before, mut last): (Vec<usize>, Vec<usize>) = (vec![], (0..=b.len()).collect());
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let replaced = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            row[j] = replaced.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(before[j - 2] + 1);
            }
        }
        (before, last) = (last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn slips_of_the_pen_are_told_from_other_words() {
        let known = ["length", "reach", "stride", "max_gap"];
        assert_eq!(meant("lenght", known), Some("length"));
        assert_eq!(meant("Reach", known), Some("reach"));
        assert_eq!(meant("maxgap", known), Some("max_gap"));
        assert_eq!(meant("width", known), None);
        assert_eq!(meant("", known), None);
        assert_eq!((meant("y", ["t", "q"]), meant("Y", ["t", "y"])), (None, Some("y")));
        assert_eq!(meant(&"length".repeat(1000), known), None);
        let of = |a: &str, b: &str| distance(&a.chars().collect::<Vec<_>>(), &b.chars().collect::<Vec<_>>());
        assert_eq!((of("ab", "ba"), of("", "abc"), of("kitten", "sitting"), of("same", "same")), (1, 3, 3, 0));
    }
}
