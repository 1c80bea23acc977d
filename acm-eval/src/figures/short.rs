//! Short names for figures.

/// Shortens words to so many letters; the last is `…` where there are more.
pub fn short(words: &str, letters: usize) -> String {
    if words.chars().count() <= letters {
        return words.to_string();
    }
    words.chars().take(letters.saturating_sub(1)).chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_name_ends_in_dots() {
        assert_eq!((short("tilt", 4).as_str(), short("tilt_x", 4).as_str()), ("tilt", "til…"));
    }
}
