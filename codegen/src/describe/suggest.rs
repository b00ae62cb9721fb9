//! "Did you mean ...?"

/// The candidate that a misspelt word is closest to, if any is close.
///
/// Close means a third of the letters or fewer inserted, left out, exchanged or swapped.
pub(crate) fn nearest<'c>(
    word: &str,
    candidates: impl IntoIterator<Item = &'c str>,
) -> Option<&'c str> {
    let word: Vec<char> = word.to_lowercase().chars().take(64).collect();
    let allowed = (word.len() / 3).max(1);
    candidates
        .into_iter()
        .filter(|candidate| candidate.chars().count().abs_diff(word.len()) <= allowed)
        .map(|candidate| (distance(&word, candidate), candidate))
        .filter(|(far, _)| *far <= allowed)
        .min_by_key(|(far, _)| *far)
        .map(|(_, candidate)| candidate)
}

/// Help for a word that is none of the candidates: the nearest one, or all of them.
pub(crate) fn help(word: &str, candidates: &[&str]) -> String {
    match nearest(word, candidates.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None if candidates.is_empty() => "there is none to choose from".to_owned(),
        None => format!("known: {}", listed(candidates)),
    }
}

/// `a, b, c`, cut off where a list gets tiring.
pub(crate) fn listed(words: &[&str]) -> String {
    const SHOWN: usize = 12;
    match words.get(..SHOWN) {
        Some(first) if words.len() > SHOWN => format!("{}, ...", first.join(", ")),
        _ => words.join(", "),
    }
}

/// Edit distance in which two swapped neighbours count once.
fn distance(word: &[char], candidate: &str) -> usize {
    let candidate: Vec<char> = candidate.to_lowercase().chars().take(64).collect();
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=candidate.len()).collect();
    for (i, &a) in word.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, &b) in candidate.iter().enumerate() {
            let exchanged = last[j] + usize::from(a != b);
            let mut least = exchanged.min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && word[i - 1] == b && candidate[j - 1] == a {
                least = least.min(before[j - 1] + 1);
            }
            row.push(least);
        }
        before = std::mem::replace(&mut last, row);
    }
    last.last().copied().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_finds_typing_mistakes_and_nothing_else() {
        let words = ["name", "gravity", "effects", "coulomb"];
        assert_eq!(nearest("nmae", words), Some("name"));
        assert_eq!(nearest("Gravty", words), Some("gravity"));
        assert_eq!(nearest("colomb", words), Some("coulomb"));
        assert_eq!(nearest("stiction", words), None);
        assert_eq!(nearest("", words), None);
    }
}
