//! [`diagnosis`]: what happened to a file, what it looks like and what to do, in one to three sentences.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use darboux::{BitangentDirection, Choice};
use darboux_io::words::{Count, listed};

use crate::check_options::{AssumedMap, CheckOptions};
use crate::code::Code;
use crate::report::ReportedFinding;
use crate::severity::Severity;

/// What happened to a file, what it looks like and what to do, in one to three sentences: the first thing
/// that a report says.
///
/// `findings`: those of the file, before or after a repair. `options`: those of the check; a further sentence
/// tells what they say of normal maps, where that is not what glTF says.
pub fn diagnosis(findings: &[ReportedFinding], options: &CheckOptions) -> String {
    of_findings(findings, options) + &expected(options)
}

/// The sentences about findings.
fn of_findings(findings: &[ReportedFinding], options: &CheckOptions) -> String {
    let left = || findings.iter().filter(|finding| finding.repaired != Some(true));
    let repaired = findings.len() - left().count();
    let Some(worst) = left().map(|finding| finding.severity).max().filter(|worst| *worst > Severity::Info)
    else {
        return healthy(findings, repaired);
    };
    let of_severity: Vec<&ReportedFinding> = left().filter(|finding| finding.severity == worst).collect();
    let main = main_code(&of_severity);
    let first = of_severity.iter().copied().find(|finding| finding.code == main);
    let is_same = |finding: &&ReportedFinding| first.is_some_and(|first| first.says_the_same(finding));
    let of_main: Vec<&ReportedFinding> = of_severity.iter().copied().filter(is_same).collect();
    let others = of_severity.len() - of_main.len();
    let happened = happened(main, &of_main, others, worst, options.green);
    let first = of_main[0];
    format!("{happened} {} {}", first.looks_like, to_do(first, &of_severity, options))
}

/// The code that most findings have; of several, the first one, as causes come before what follows from them.
fn main_code(findings: &[&ReportedFinding]) -> Code {
    let mut counts: BTreeMap<Code, (usize, usize)> = BTreeMap::new();
    for (number, finding) in findings.iter().enumerate() {
        counts.entry(finding.code).or_insert((0, number)).0 += 1 + finding.same_as;
    }
    let most = counts.into_iter().max_by_key(|(_, (count, first))| (*count, Reverse(*first)));
    most.map_or(findings[0].code, |(code, _)| code)
}

/// The sentence about the convention that normal maps should have, and the one about what they were taken to
/// be; empty by default, and where maps are not judged.
fn expected(options: &CheckOptions) -> String {
    if !options.maps {
        return String::new();
    }
    let wanted = match options.green {
        BitangentDirection::Up => "",
        BitangentDirection::Down => " Green of normal maps was expected to point down (DirectX).",
    };
    let assumed = options.assumed_map.map(|assumed| match assumed {
        AssumedMap::OpenGl => "that of OpenGL (green up)",
        AssumedMap::DirectX => "that of DirectX (green down)",
        AssumedMap::RedInverted => "that of OpenGL with inverted red",
        AssumedMap::BothInverted => "that of OpenGL with inverted red and green",
    });
    let assumed = assumed.map_or_else(String::new, |convention| {
        format!(" Where nothing shows the convention of a map, it was taken to be {convention}.")
    });
    wanted.to_owned() + &assumed
}

/// The sentence about what happened.
fn happened(
    main: Code,
    of_main: &[&ReportedFinding],
    others: usize,
    worst: Severity,
    wanted: BitangentDirection,
) -> String {
    let first = of_main[0];
    let place = listed(&of_main.iter().map(|finding| &*finding.place).collect::<Vec<&str>>());
    let kind = if worst == Severity::Error { "error" } else { "warning" };
    let others = match others {
        0 => String::new(),
        1 => format!(" 1 other {kind} is listed below."),
        count => format!(" {} other {kind}s are listed below.", Count(count)),
    };
    format!("{place}: {}.{others}{}", first.text.trim_end_matches('.'), usual_cause(main, wanted))
}

/// The sentence about how findings of a kind come about; empty where the text of each finding says it.
fn usual_cause(code: Code, wanted: BitangentDirection) -> String {
    match code {
        Code::MapGreenFlipped if wanted == BitangentDirection::Down => {
            " A usual cause: an OpenGL map was put into a project that wants DirectX's.".to_owned()
        }
        Code::TangentOtherRecipe | Code::ConventionsCancel => String::new(),
        _ => format!(" A usual cause: {}", lower_case(&without_references(code.cause()))),
    }
}

/// A sentence without the numbers of issues, which are in parentheses.
fn without_references(sentence: &str) -> String {
    let mut parts = sentence.split(" (");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        match part.split_once(')') {
            Some((inside, after)) if inside.contains(|letter: char| letter.is_ascii_digit()) => text += after,
            _ => text += &format!(" ({part}"),
        }
    }
    text
}

/// A sentence after a colon.
fn lower_case(sentence: &str) -> String {
    let mut letters = sentence.chars();
    let is_name = letters.clone().nth(1).is_none_or(|second| second.is_uppercase())
        || ["DirectX", "Blender", "Unreal"].iter().any(|name| sentence.starts_with(name));
    match letters.next() {
        Some(first) if !is_name => first.to_lowercase().chain(letters).collect(),
        _ => sentence.to_owned(),
    }
}

/// What to do about findings, of which one was told.
fn to_do(told: &ReportedFinding, findings: &[&ReportedFinding], options: &CheckOptions) -> String {
    let option = match options.green {
        BitangentDirection::Up => "",
        BitangentDirection::Down => " --convention directx",
    };
    let assumed = options.assumed_map.map(|assumed| format!(" --assume map={}", assumed.name()));
    let assumed = assumed.unwrap_or_default();
    let fixable = findings.iter().filter(|finding| finding.is_repairable()).count();
    if fixable == findings.len() {
        return format!("Type `darboux check FILE{option}{assumed} --fix` to repair it.");
    }
    if fixable > 0 {
        let all = findings.len();
        return format!(
            "`darboux check FILE{option}{assumed} --fix` repairs {fixable} of these {all}; the others say why not."
        );
    }
    match told.suggested_assumption {
        Some(assumed) => format!(
            "The file does not say for certain which of two repairs is right: look, and if it is so, type `darboux \
             check FILE{option} --fix --assume map={}`.",
            assumed.name()
        ),
        None => told.cure.clone(),
    }
}

/// The sentence about a file in which nothing is wrong.
fn healthy(findings: &[ReportedFinding], repaired: usize) -> String {
    let unchecked = findings.iter().filter(|finding| finding.severity == Severity::NotChecked).count();
    let nothing = match repaired {
        0 => "Nothing is wrong.".to_owned(),
        1 => "1 finding was repaired, and nothing is wrong any more.".to_owned(),
        count => format!("{} findings were repaired, and nothing is wrong any more.", Count(count)),
    };
    match unchecked {
        0 => nothing,
        1 => format!("{nothing} 1 normal map was not checked; its finding says why."),
        count => {
            format!("{nothing} {} normal maps were not checked; their findings say why.", Count(count))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_are_left_out() {
        let sentence = "A DirectX map (green down) was put into glTF (glTF 1637, filament 528), or so.";
        assert_eq!(without_references(sentence), "A DirectX map (green down) was put into glTF, or so.");
    }

    #[test]
    fn nothing_is_wrong_without_findings() {
        assert_eq!(diagnosis(&[], &CheckOptions::default()), "Nothing is wrong.");
    }

    /// Parts whose tangents another method made, or that are left, have findings of their own.
    #[test]
    fn only_places_of_which_it_is_true_are_named() {
        let finding = |place: &str, text: &str| ReportedFinding {
            code: Code::TangentOtherRecipe,
            severity: Severity::Warning,
            place: place.to_owned(),
            mesh: None,
            mesh_name: None,
            primitive: None,
            source: None,
            same_as: 0,
            material: None,
            image: None,
            count: 1,
            first: Vec::new(),
            first_are: "vertices",
            evidence: Vec::new(),
            text: text.to_owned(),
            looks_like: "",
            cure: String::new(),
            fixable: true,
            left_because: None,
            suggested_assumption: None,
            repaired: None,
            change: None,
        };
        let others = [finding("a", "12 corners differ"), finding("b", "3 corners differ")];
        let left = ReportedFinding { left_because: Some(String::new()), ..finding("c", "12 corners differ") };
        let all = others.into_iter().chain([left, finding("d", "they are Lengyel's")]).collect::<Vec<_>>();
        let told = diagnosis(&all, &CheckOptions::default());
        assert!(told.starts_with("a and b: 12 corners differ. 2 other warnings are listed below."), "{told}");
    }

    /// A healthy DirectX map is one only where that is expected.
    #[test]
    fn what_is_expected_is_told() {
        let options = CheckOptions::default().with_green(BitangentDirection::Down);
        let expected = "Nothing is wrong. Green of normal maps was expected to point down (DirectX).";
        assert_eq!(diagnosis(&[], &options), expected);
        let assumed = CheckOptions::default().with_assumed_map(Some(AssumedMap::DirectX));
        let expected = "Nothing is wrong. Where nothing shows the convention of a map, it was taken to be that \
             of DirectX (green down).";
        assert_eq!(diagnosis(&[], &assumed), expected);
        assert_eq!(diagnosis(&[], &assumed.with_maps(false)), "Nothing is wrong.");
    }
}
