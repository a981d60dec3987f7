//! Did you mean: the known word nearest to an unknown one.

use std::cmp::Reverse;

/// The candidate most like `word`: about one letter in three may differ, and a difference of case counts half. Among
/// equals the one with the longest common start wins, then the first.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word: Vec<char> = word.chars().collect();
    let limit = (2 * word.len().div_ceil(3)).min((2 * word.len()).saturating_sub(1));
    candidates
        .into_iter()
        .map(|candidate| (distance(&word, candidate), Reverse(common_start(&word, candidate)), candidate))
        .filter(|(distance, ..)| *distance <= limit)
        .min_by_key(|&(distance, start, _)| (distance, start))
        .map(|(.., candidate)| candidate)
}

/// Edit distance in half steps: 2 for a letter inserted, removed or replaced, 1 for a change of case.
fn distance(word: &[char], candidate: &str) -> usize {
    let mut row: Vec<usize> = (0..=word.len()).map(|k| 2 * k).collect();
    for c in candidate.chars() {
        let mut diagonal = row[0];
        row[0] += 2;
        for (k, &w) in word.iter().enumerate() {
            let replaced = diagonal + replacement(w, c);
            diagonal = row[k + 1];
            row[k + 1] = replaced.min(diagonal + 2).min(row[k] + 2);
        }
    }
    row[word.len()]
}

/// Cost of writing `b` for `a`.
fn replacement(a: char, b: char) -> usize {
    if a == b {
        0
    } else if a.eq_ignore_ascii_case(&b) {
        1
    } else {
        2
    }
}

/// Number of letters at the start that agree.
fn common_start(word: &[char], candidate: &str) -> usize {
    word.iter().zip(candidate.chars()).take_while(|(a, b)| **a == *b).count()
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn small_slips_are_recognised() {
        let names = ["Pressure", "Velocity", "kPa", "ms", "um", "us", "K"];
        assert_eq!(nearest("Presure", names), Some("Pressure"));
        assert_eq!(nearest("velocity", names), Some("Velocity"));
        assert_eq!(nearest("kpa", names), Some("kPa"));
        assert_eq!(nearest("ums", names), Some("um"));
        assert_eq!(nearest("k", names), Some("K"));
    }

    #[test]
    fn unlike_words_are_not_suggested() {
        assert_eq!(nearest("x", ["K", "m"]), None);
        assert_eq!(nearest("", ["K", "m"]), None);
        assert_eq!(nearest("stiffness", ["Pressure"]), None);
    }
}
