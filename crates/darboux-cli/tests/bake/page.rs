//! The page of `--report`: its pictures, and the numbers of the JSON.

use std::fs;

use serde_json::{Value, json};

use crate::common::{darboux, darboux_without_adapters, has_adapter, text};
use crate::pair::{FULL, Pair, edited, plate};

/// Expects a page that loads nothing.
fn check_alone(html: &str) {
    assert_eq!(html.matches("src=").count(), html.matches("src=\"data:image/png;base64,").count());
    for part in ["<script", "<link", "url(", "http:", "https:", "href="] {
        assert!(!html.contains(part), "{part}");
    }
}

/// Two plates beside each other as one low model, so that it has two parts.
fn two_parts() -> Vec<u8> {
    edited(&plate([0.0, 0.0], &FULL, 1.0), |json| {
        json["nodes"] = json!([
            {"name": "left & low", "mesh": 0, "scale": [0.5, 1, 1]},
            {"name": "right", "mesh": 1, "scale": [0.5, 1, 1], "translation": [0.5, 0, 0]},
        ]);
        json["scenes"] = json!([{"nodes": [0, 1]}]);
        json["meshes"] = json!([json["meshes"][0], json["meshes"][0]]);
    })
}

#[test]
fn a_page_has_every_map_and_the_numbers_of_the_json() {
    let pair = Pair::new();
    fs::write(pair.path("low.glb"), two_parts()).expect("a file");
    let page = pair.path("report.html");
    let maps =
        ["--map", "normal,ao,height,uv-islands,roughness,metalness", "--pack", "orm=ao,roughness,metalness"];
    let more = ["--verify", "--report", text(&page), "--json"];
    let report = pair.bake(&[&maps[..], &more].concat()).exits(0).json();
    assert_eq!(report["report"], text(&page));
    let html = fs::read_to_string(&page).expect("a page");
    check_alone(&html);
    let written = report["maps"].as_array().expect("a list");
    assert_eq!(written.len(), 7);
    for map in written {
        let [name, file] = ["map", "file"].map(|field| map[field].as_str().expect("a text"));
        assert!(html.contains(&format!("<figcaption>{name}<br><code>{file}</code><br>")), "{name}");
    }
    assert!(html.contains("<br>black is -1, white 1"), "the range of the heights");
    assert!(html.contains("class=\"legend\"") && html.contains("fill=\"#"));
    // Errors with four digits, as the summary has them, of the whole and of each part.
    let verification = &report["verification"];
    let row = |errors: &Value| {
        let cell = |field: &str| {
            format!("<td class=\"number\">{:.4}</td>", errors[field].as_f64().expect("a number"))
        };
        let angles = ["median", "mean", "p95", "p99", "worst"].map(cell).concat();
        format!("<td class=\"number\">{}</td>{angles}</tr>", errors["points"])
    };
    assert!(html.contains(&format!("<tr><td>the written map</td>{}", row(&verification["all"]))));
    let parts = verification["parts"].as_array().expect("a list");
    assert_eq!(parts.len(), 2);
    let points: u64 = parts.iter().map(|part| part["points"].as_u64().expect("a number")).sum();
    assert_eq!(verification["all"]["points"], points);
    assert!(html.contains(&format!("<tr><td>left &amp; low</td>{}", row(&parts[0]))), "{parts:?}");
    assert!(html.contains(&format!("<tr><td>right</td>{}", row(&parts[1]))));
    for (what, field) in [("rays", "rays"), ("texels of several triangles (overlaps)", "overlapping_texels")]
    {
        let cell = format!("<td>{what}</td><td class=\"number\">{}</td>", report["counts"][field]);
        assert!(html.contains(&cell), "{cell}");
    }
    for warning in report["warnings"].as_array().expect("a list") {
        let start = warning.as_str().expect("a text").split('`').next().unwrap_or_default();
        assert!(html.contains(start), "{start}");
    }
    let seconds = &report["seconds"];
    assert!(
        seconds["rays"].as_f64().expect("a number") > 0.0 && html.contains("<td>reading the models</td>")
    );
    // Seven maps, the errors, and four sides of two models.
    let pictures = if has_adapter() { 16 } else { 8 };
    assert_eq!(html.matches("<img ").count(), pictures);
    // Nothing is replaced unasked, and the maps stay as they are.
    assert!(
        pair.bake(&["--report", text(&page)]).exits(2).stderr.contains("report.html: exists; use --force")
    );
}

#[test]
fn a_page_says_what_it_has_no_pictures_of() {
    let pair = Pair::new();
    let [low, high, map, page] =
        ["low.glb", "high.glb", "map.png", "report.html"].map(|name| pair.path(name));
    let line = ["bake", text(&low), "--high", text(&high), "-o", text(&map), "--size", "16", "--force"];
    let with = |more: &[&'static str]| [&line[..], &["--report", text(&page)], more].concat();
    let html = || fs::read_to_string(&page).expect("a page");
    darboux_without_adapters(&with(&["--cage-offset", "1"])).exits(0);
    assert!(html().contains("There is no picture: no graphics adapter was found"));
    darboux(&with(&["--cage-offset", "1", "--map", "height"])).exits(0);
    assert!(html().contains("There is no picture: none of the maps is one that materials of glTF have"));
    // Half of the rays end below the roof.
    let report = darboux(&with(&["--cage-offset", "0.25", "--json"])).exits(0).json();
    let counts = &report["counts"];
    let sentence = format!("{} of {} texels", counts["missed_texels"], counts["charted_texels"]);
    assert!(html().contains(&sentence) && html().contains("Rays that hit nothing"), "{sentence}");
    // One page has all tiles.
    let tiles = pair.path("t.%UDIM%.png");
    let line = ["bake", text(&low), "--high", text(&high), "-o", text(&tiles), "--size", "16", "--force"];
    let more = ["--cage-offset", "1", "--verify", "--report", text(&page)];
    darboux(&[&line[..], &more].concat()).exits(0);
    assert!(html().contains("Maps, tile 1001") && html().contains("Error of the normal map, tile 1001"));
    assert!(html().contains("There is no picture: materials of glTF cannot have UDIM tiles"));
    check_alone(&html());
}

#[test]
fn jobs_have_pages_and_other_names_are_refused() {
    let pair = Pair::new();
    let job = pair.path("job.toml");
    let entry = "[[bake]]\nlow = \"low.glb\"\nhigh = \"high.glb\"\noutput = \"a.png\"\nsize = 8\ncage-offset = 1\nreport = \"a.html\"\n";
    fs::write(&job, entry).expect("a file");
    let resumed = || darboux(&["bake", text(&job), "--resume", "--json"]).exits(0).json();
    assert_eq!(resumed()["bakes"][0]["report"], text(&pair.path("a.html")));
    assert_eq!(resumed()["up_to_date"], 1);
    // A lost page is written again.
    fs::remove_file(pair.path("a.html")).expect("a page");
    assert_eq!(resumed()["up_to_date"], 0);
    for (name, sentence) in [
        ("report.pdf", "its name must end in .html"),
        ("missing/report.html", "does not exist"),
        ("report.%UDIM%.html", "one page has all tiles"),
    ] {
        let page = pair.path(name);
        let stderr = pair.bake(&["--report", text(&page)]).exits(2).stderr;
        assert!(stderr.contains(sentence), "{stderr}");
    }
    assert!(!pair.path("map.png").exists());
}
