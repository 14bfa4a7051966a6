//! `darboux report` and `check --report`: one page with the diagnosis, pictures and findings.

mod common;

use std::fs;

use common::{asset, darboux, darboux_without_adapters, has_adapter, text};

#[test]
fn a_page_has_the_diagnosis_pictures_and_one_entry_per_kind() {
    let folder = tempfile::tempdir().expect("a folder");
    let (model, page) = (asset("made/shield.glb"), folder.path().join("report.html"));
    let report = |more: &[&str]| darboux(&[&["report", text(&model), "-o", text(&page)], more].concat());
    assert!(report(&[]).exits(1).stderr.contains("1 with errors"));
    let html = fs::read_to_string(&page).expect("a page");
    let place = |part: &str| html.find(part).unwrap_or_else(|| panic!("the page has no {part}"));
    assert!(place("class=\"diagnosis\"") < place("<article"));
    let findings = darboux(&["check", text(&model), "--json"]).exits(1).json();
    for finding in findings["files"][0]["findings"].as_array().expect("a list") {
        let code = finding["code"].as_str().expect("a code");
        assert_eq!(html.matches(&format!("<code>{code}</code></h3>")).count(), 1, "{code}");
    }
    if has_adapter() {
        assert_eq!(html.matches("src=\"data:image/png;base64,").count(), 4, "two pictures of two sides");
    }
    // Nothing is loaded from elsewhere.
    assert_eq!(html.matches("src=").count(), html.matches("src=\"data:").count());
    assert!(!html.contains("<link") && !html.contains("url("));

    assert!(report(&[]).exits(1).stderr.contains("exists; use --force"));
    report(&["--force", "--fail-on", "never", "--pictures", "0"]).exits(0);
    let other = folder.path().join("other.html");
    darboux(&["check", text(&model), "--report", text(&other), "--quiet"]).exits(1);
    assert!(fs::read_to_string(other).expect("a page") == html, "check writes the same page");
}

#[test]
fn without_an_adapter_and_with_bad_files_the_page_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let (model, broken) = (folder.path().join("a & b.glb"), folder.path().join("broken.glb"));
    fs::copy(asset("made/shield.glb"), &model).expect("a model");
    fs::write(&broken, "glTF").expect("a file");
    let page = folder.path().join("report.html");
    darboux_without_adapters(&["report", text(folder.path()), "-o", text(&page)]).exits(1);
    let html = fs::read_to_string(&page).expect("a page");
    assert!(html.contains("There is no picture: no graphics adapter was found"));
    assert!(html.contains("a &amp; b.glb") && !html.contains("a & b.glb"));
    assert!(html.contains("cannot be read") && html.contains("<nav aria-label=\"Files\">"));
}

#[test]
fn what_cannot_be_a_report_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = folder.path().join("report.html");
    for (input, output, sentence) in [
        ("a.glb", "report.pdf", "its name must end in .html"),
        ("a.glb", "missing/report.html", "does not exist"),
        ("-", text(&page), "save standard input to a file first"),
    ] {
        for line in [["report", input, "-o", output], ["check", input, "--report", output]] {
            assert!(darboux(&line).exits(2).stderr.contains(sentence), "{line:?}");
        }
    }
    darboux(&["check", "a.glb", "--fix", "--report", text(&page)]).exits(2);
    assert!(!page.exists());
}
