//! Two mistakes on one model are both named, or docs/check-mistakes.md says why not, and the repair leaves
//! nothing without a reason.

mod support;

use std::fs;
use std::path::Path;

use support::page::{PAIRS, pair_line, pairs_section, why_missed};
use support::pairs::{Outcome, PairRow, all_pairs, rows};

/// The page of the pairs.
const PAGE: &str = "../../docs/check-mistakes.md";

fn page() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(PAGE)).expect("the page")
}

fn assert_repaired(rows: &[PairRow]) {
    let failures: Vec<String> = rows
        .iter()
        .filter_map(|row| {
            row.failure
                .as_ref()
                .map(|failure| format!("{} after {}: {failure}", row.made[1].how(), row.made[0].how()))
        })
        .collect();
    assert!(failures.is_empty(), "{failures:#?}");
}

/// Every ninth pair.
#[test]
fn some_pairs_are_named_as_the_page_says() {
    let pairs: Vec<_> = all_pairs().into_iter().step_by(9).collect();
    let (rows, page) = (rows(&pairs), page());
    assert_repaired(&rows);
    for row in &rows {
        let is_listed = page.contains(&pair_line(row));
        let is_missed = matches!(row.outcome, Outcome::Missed { .. });
        assert_eq!(is_listed, is_missed, "{} after {}", row.made[1].how(), row.made[0].how());
    }
}

#[test]
#[ignore = "takes minutes"]
fn all_pairs_are_named_and_repaired_as_the_page_says() {
    let rows = rows(&all_pairs());
    let section = pairs_section(&rows);
    let committed = page();
    let (mistakes, pairs) = committed.split_once(PAIRS).expect("a part about pairs");
    if std::env::var_os("WRITE_PAGES").is_some() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(PAGE);
        fs::write(path, format!("{mistakes}{PAIRS}{section}")).expect("the page can be written");
    } else {
        assert!(pairs == section, "{PAGE} is not what is found now; write it again with WRITE_PAGES=1");
    }
    assert_repaired(&rows);
    let is_unexplained = |row: &&PairRow| {
        let is_missed = matches!(row.outcome, Outcome::Missed { .. });
        is_missed && why_missed(row.made.map(|made| made.code())).is_empty()
    };
    let unexplained: Vec<String> = rows.iter().filter(is_unexplained).map(pair_line).collect();
    assert!(unexplained.is_empty(), "{unexplained:#?}");
}
