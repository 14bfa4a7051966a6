"""Writes docs/conformance.md, results/index.html and WRONG.md from the summaries in results/.
"""

import argparse
import html
import json
import sys
from pathlib import Path

import casefile
import model_page
import wrong
from judge import CLASSES, LEVELS

HERE = Path(__file__).resolve().parent
PAGE, TABLE, WRONG = HERE / "results/index.html", HERE.parent / "docs/conformance.md", HERE / "WRONG.md"
REFERENCE = "mikktspace-c"
OTHERS = "These do not claim to compute MikkTSpace. A case that fails is no defect of theirs; it says where a map baked with MikkTSpace looks different."
OTHERS_DRAWN = "These do not claim to compute MikkTSpace, so a difference is no defect of theirs."


def summaries():
    """The newest summary of every implementation: the reference first, then the others by the share of cases that pass."""
    newest = {}
    for path in (HERE / "results").glob("*/*.json"):
        summary = json.loads(path.read_text(encoding="utf-8"))
        if (summary["date"], path.name) > newest.get(summary["id"], (("", ""),))[0]:
            newest[summary["id"]] = ((summary["date"], path.name), summary)

    def rank(summary):
        shares = tuple(-sum(c["levels"][level] for c in summary["classes"].values()) for level in ("angle", "bits"))
        return (summary["id"] != REFERENCE, not summary.get("ours"), *shares, summary["name"])

    return sorted((summary for _, summary in newest.values()), key=rank)


def cell(own):
    """Cases that pass at the levels bits, angle and seams, and how many were judged."""
    judged = own["cases"] - own["skipped"]
    return "-" if not judged else " ".join(str(own["levels"][level]) for level in LEVELS) + f" / {judged}"


def nanoseconds(summary):
    value = summary.get("ns_per_triangle")
    return "-" if value is None else f"{value:,.0f}"


def markdown(all_of_them):
    lines = [
        "# Who computes MikkTSpace",
        "",
        "Implementations from package registries and Debian, judged by the [conformance suite](../conformance/README.md). Made by",
        "`cargo xtask conformance`; [the page with pictures](../conformance/results/index.html) shows every failing case. Your own code gets a verdict in",
        "ten minutes and in any language: [how](../conformance/README.md#a-verdict-on-your-code-in-ten-minutes).",
        "",
        "A cell says how many cases of a class pass at the levels `bits`, `angle` and `seams`, and how many were judged: implementations without",
        "quads or thresholds skip those cases. The time is processor time per triangle of the case large-terrain (20,000 triangles), the least of five",
        "runs (Darboux's modes: wall time); files are not timed.",
        "",
        *table([s for s in all_of_them if not is_another_method(s)]),
        "",
        "## Other methods, for comparison",
        "",
        f"{OTHERS}",
        "",
        *table([s for s in all_of_them if is_another_method(s)]),
    ]
    made = model_page.read()
    lines += ["", *model_page.markdown(made, *model_page.parts(made, REFERENCE, is_another_method), OTHERS_DRAWN)]
    machines = sorted({s["machine"] for s in all_of_them})
    lines += ["", f"Machine: {'; '.join(machines)}. What they are installed from: " + "; ".join(f"{s['name']}: {s['package']}" for s in all_of_them) + ".", ""]
    lines += ["[WRONG.md](../conformance/WRONG.md) shows on which of them wrong inputs and wrong builds were tried, and how many cases noticed.", "", "## Reports", ""]
    lines += [f"- [{title(path)}](../conformance/reports/{path.name})" for path in sorted((HERE / "reports").glob("*.md")) if path.name != "README.md"]
    lines += ["", "## Not in the table", "", "| implementation | reason |", "|---|---|"]
    lines += [f"| {name} | {reason} |" for name, reason in unavailable()]
    return "\n".join(lines) + "\n"


def table(some):
    """The head and the rows of a table in Markdown."""
    lines = ["| implementation | version | date | " + " | ".join(CLASSES) + " | ns per triangle |", "|---|---|---|" + "---|" * len(CLASSES) + "--:|"]
    for s in some:
        name = f"**{s['name']}**" if s.get("ours") else s["name"]
        cells = [cell(s["classes"][c]) if c in s["classes"] else "-" for c in CLASSES]
        lines.append(f"| {name} | {s['version']} | {s['date']} | " + " | ".join(cells) + f" | {nanoseconds(s)} |")
    return lines


def is_another_method(summary):
    return (summary.get("claims") or "").startswith(("another method", "other weights"))


def title(path):
    return path.read_text(encoding="utf-8").splitlines()[0].lstrip("# ")


def unavailable():
    return json.loads((HERE / "unavailable.json").read_text(encoding="utf-8"))


def wrong_builds(all_of_them):
    """What wrong.py counted: per implementation and wrong input, the cases that notice it."""
    heads = [f"{change.name} ({change.noticed_by})" for change in wrong.CHANGES]
    lines = [
        "# Wrong builds and wrong inputs",
        "",
        "Made by `cargo xtask conformance --wrong` (`python3 conformance/wrong.py`): proof that an adapter reads its cases and that the suite can fail it.",
        "A cell says how many cases of the class notice what is wrong, of how many that the adapter runs: such a case passes a level less, or more of its",
        "corners have a wrong sign or a wrong angle. `-`: the adapter runs no case of the class. 0: the mistake changes nothing there, because the",
        "implementation makes it already (one tangent per vertex, no sign) or is as far from the reference without it.",
        "",
        "| wrong input | what is wrong |",
        "|---|---|",
        *[f"| {change.name} | {change.sentence} |" for change in wrong.CHANGES],
        "",
        "A wrong build is the adapter with one operation of it or of the implementation changed; its `adapter.json` says where. For Darboux it is another",
        "mode: that its own code is noticed when an operation changes is what [MUTATIONS.md](MUTATIONS.md) shows of its twin.",
        "",
        "| implementation | " + " | ".join(heads) + " | wrong build |",
        "|---|" + "--:|" * len(heads) + "---|",
    ]
    for s in all_of_them:
        proof = s.get("wrong")
        if not proof:
            continue
        cells = ["/".join(map(str, proof["inputs"][change.name])) if change.name in proof["inputs"] else "-" for change in wrong.CHANGES]
        build = proof["build"]
        cells.append(f"{build['noticed']}/{build['cases']} {build['class']}: {build['what']}" if build else "-")
        lines.append(f"| {s['name']} {s['version']} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def page(all_of_them):
    cases = {case["name"]: case for case in casefile.read_all()}
    shown = {row["name"] for s in all_of_them for row in s["failing"] if "tangents" in row}
    geometry = {name: picture_data(cases[name]) for name in sorted(shown)}
    sentences = {path.stem: json.loads(path.read_text(encoding="utf-8"))["shows"] for path in casefile.CASES.glob("*.json")}
    data = {
        "cases": geometry,
        "found": {s["id"]: {row["name"]: row["tangents"] for row in s["failing"] if "tangents" in row} for s in all_of_them},
    }
    rows = "\n".join(table_row(s) for s in all_of_them if not is_another_method(s))
    rows += f'\n<tr><th colspan="{len(CLASSES) + 2}">{html.escape(OTHERS)}</th></tr>\n'
    rows += "\n".join(table_row(s) for s in all_of_them if is_another_method(s))
    details = "\n".join(section(s, sentences) for s in all_of_them if s["failing"])
    absent = "\n".join(f"<tr><th>{html.escape(name)}</th><td>{html.escape(reason)}</td></tr>" for name, reason in unavailable())
    heads = "".join(f"<th>{name}</th>" for name in CLASSES)
    embedded = json.dumps(data, separators=(",", ":")).replace("</", "<\\/")
    template = (HERE / "page.html").read_text(encoding="utf-8")
    bars = "\n".join(bar_row(s) for s in all_of_them if not s.get("ours") and not is_another_method(s))
    others = "\n".join(bar_row(s) for s in all_of_them if is_another_method(s))
    made = model_page.read()
    real = model_page.section(made, *model_page.parts(made, REFERENCE, is_another_method), OTHERS_DRAWN)
    parts = {"MODEL": real, "SUMMARY": headline(all_of_them), "DARBOUX": darboux_row(all_of_them), "BARS": bars, "OTHERS": others, "OTHERS_WORDS": html.escape(OTHERS)}
    for key, value in {**parts, "HEADS": heads, "ROWS": rows, "DETAILS": details, "ABSENT": absent, "DATA": embedded}.items():
        template = template.replace(f"<!-- {key} -->", value)
    return template


GLYPHS = {"bits": "●", "angle": "◐", "seams": "○", "fails": "✕", "skipped": "–"}
WORDS = {"bits": "equal in bits", "angle": "within 0.1°", "seams": "signs and seams right", "fails": "signs or seams wrong", "skipped": "not judged"}


def counts(own):
    """Cases of a class by the best level that they pass, and those that were not judged."""
    levels = [own["levels"][level] for level in LEVELS]
    judged = own["cases"] - own["skipped"]
    best = [after - before for before, after in zip([0, *levels], [*levels, judged])]
    return dict(zip(GLYPHS, [*best, own["skipped"]]))


def all_counts(s):
    by_class = [counts(own) for own in s["classes"].values()]
    return {level: sum(one[level] for one in by_class) for level in GLYPHS}


def bar(s):
    """A strip with one cell per case, grouped by class."""
    at, parts = 0, []
    for name in CLASSES:
        if name not in s["classes"]:
            continue
        for level, count in counts(s["classes"][name]).items():
            if count:
                parts.append(f'<rect class="{level}" x="{at}" width="{count}" height="10"><title>{name}: {count} {WORDS[level]}</title></rect>')
                at += count
        parts.append(f'<rect class="gap" x="{at - 0.25}" width="0.5" height="10"/>')
    total = all_counts(s)
    words = ", ".join(f"{count} {WORDS[level]}" for level, count in total.items() if count)
    return f'<svg class="bar" viewBox="0 0 {at} 10" preserveAspectRatio="none" role="img" aria-label="{words}">{"".join(parts)}</svg>'


def share(s):
    total = all_counts(s)
    judged = sum(total.values()) - total["skipped"]
    return f'{GLYPHS["bits"]} {total["bits"]} of {judged}' if judged else "-"


def bar_line(s):
    name = html.escape(s["name"])
    name = f'<a href="#{s["id"]}">{name}</a>' if s["failing"] else name
    return f'<span class="name">{name}</span><span class="share">{share(s)}</span>{bar(s)}'


def bar_row(s):
    return f'<li class="row">{bar_line(s)}</li>'


def darboux_row(all_of_them):
    """Darboux as one row, with its modes and interfaces inside."""
    ours = [s for s in all_of_them if s.get("ours")]
    first = next(s for s in ours if s["id"] == "darboux-reference")
    default = all_counts(next(s for s in ours if s["id"] == "darboux-repaired"))
    rest = "\n".join(bar_row(s) for s in ours if s is not first)
    head = f'<span class="row"><span class="name">Darboux, mode reference</span><span class="share">{share(first)}</span>{bar(first)}</span>'
    words = f"The default mode, <em>repaired</em>, is not equal in bits everywhere by intent: in {default['angle']} cases it gives usable tangents where MikkTSpace gives none. All of its {sum(default.values())} cases are within 0.1°."
    return f'<li><details class="ours"><summary>{head}</summary><p>{words}</p><ul class="bars">\n{rest}\n</ul></details></li>'


def headline(all_of_them):
    """Who is right in one paragraph."""
    def is_whole(s):
        total = all_counts(s)
        return total["bits"] > 0 and total["angle"] + total["seams"] + total["fails"] == 0

    ours = [s["name"].split(", ", 1)[-1] for s in all_of_them if s.get("ours") and is_whole(s)]
    nearest = max((s for s in all_of_them if not s.get("ours") and s["id"] != REFERENCE), key=lambda s: all_counts(s)["bits"])
    total = all_counts(nearest)
    judged = sum(total.values()) - total["skipped"]
    return f'Equal to mikktspace.c in every bit of every case that they run: <strong>Darboux</strong> ({html.escape(", ".join(ours))}). Of the others, {html.escape(nearest["name"])} comes nearest: {total["bits"]} of the {judged} cases that it runs.'


def table_row(s):
    def glyph(own):
        return GLYPHS.get(shade(own), "")

    cells = "".join(f'<td class="{shade(s["classes"].get(c))}">{glyph(s["classes"].get(c))} {cell(s["classes"][c]) if c in s["classes"] else "-"}</td>' for c in CLASSES)
    name = html.escape(s["name"])
    name = f'<a href="#{s["id"]}">{name}</a>' if s["failing"] else name
    return f'<tr><th>{name}<small>{html.escape(s["version"])}, {s["date"]}</small></th>{cells}<td>{nanoseconds(s)}</td></tr>'


def shade(own):
    """The best level at which all judged cases of a class pass."""
    if not own or own["cases"] == own["skipped"]:
        return "none"
    judged = own["cases"] - own["skipped"]
    return next((level for level in LEVELS if own["levels"][level] == judged), "fails")


def section(s, sentences):
    rows = []
    by_class = {name: [row for row in s["failing"] if class_of(row["name"]) == name] for name in CLASSES}
    for name, failing in by_class.items():
        if failing:
            inner = "\n".join(failing_case(s["id"], row, sentences) for row in failing)
            rows.append(f"<details><summary>{name}: {len(failing)} cases differ from the reference</summary>\n{inner}\n</details>")
    claims = f" Claims: {html.escape(s['claims'])}." if s.get("claims") else ""
    return f'<section id="{s["id"]}"><h2>{html.escape(s["name"])}</h2><p>{html.escape(s["package"])} {html.escape(s["version"])}.{claims}</p>\n' + "\n".join(rows) + "\n</section>"


CLASS_OF = {}


def class_of(name):
    if not CLASS_OF:
        for path in casefile.CASES.glob("*.json"):
            CLASS_OF[path.stem] = json.loads(path.read_text(encoding="utf-8"))["class"]
    return CLASS_OF.get(name)


def failing_case(identity, row, sentences):
    m = row["measures"]
    numbers = [f"{m['corners'] - m['equal']} of {m['corners']} corners differ"]
    if m["largest_angle"]:
        numbers.append(f"up to {m['largest_angle']:.3g}°")
    numbers += [f"{m[key]} {words}" for key, words in (("wrong_signs", "wrong signs"), ("non_finite", "not finite"), ("zero", "zero"), ("missing_splits", "vertices not split")) if m[key]]
    level = f"passes {row['levels'][0]}" if row["levels"] else "passes no level"
    picture = f' data-of="{identity}" data-case="{row["name"]}"' if "tangents" in row else ""
    return f'<details class="case"{picture}><summary>{row["name"]} <small>{level}</small></summary><p class="numbers">{", ".join(numbers)}</p><p>The case: {html.escape(sentences[row["name"]])}</p></details>'


def picture_data(case):
    """What the page draws: triangles in the plane in which the mesh is largest, normals, UVs and the expected tangents."""
    corners, first = [], 0
    for size in case["faces"]:
        if size in (3, 4):
            corners += [first, first + 1, first + 2] + ([first, first + 2, first + 3] if size == 4 else [])
        first += size
    axes = plane(case["positions"])

    def rounded(rows):
        return [[round(x, 3) if abs(x) < 1e6 else 0 for x in row] for row in rows]

    points = fitted([[row[axis] for axis in axes] for row in case["positions"]])
    return {
        "corners": corners,
        "indices": case["indices"],
        "points": rounded(points),
        "normals": rounded(case["normals"]),
        "uvs": rounded(fitted(case["uvs"])),
        "expected": rounded(case["expected"]["tangents"]),
    }


def plane(positions):
    """The two axes along which the finite positions extend most."""
    extents = []
    for axis in range(3):
        values = [row[axis] for row in positions if abs(row[axis]) < 1e30]
        extents.append((max(values) - min(values) if values else 0.0, -axis))
    return sorted(-axis for _, axis in sorted(extents)[1:])


def fitted(rows):
    """Points moved and scaled to the unit square; what is not finite goes to the middle."""
    finite = [[x for x in column if abs(x) < 1e30] or [0.0] for column in zip(*rows)]
    lows = [min(column) for column in finite]
    size = max(max(column) - low for column, low in zip(finite, lows)) or 1.0
    return [[(x - low) / size if abs(x) < 1e30 else 0.5 for x, low in zip(row, lows)] for row in rows]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="write nothing; fail if one of them is out of date")
    given = parser.parse_args()
    found = summaries()
    written = {PAGE: page(found), TABLE: markdown(found), WRONG: wrong_builds(found)}
    if given.check:
        old = [path.name for path, text in written.items() if not path.exists() or path.read_text(encoding="utf-8") != text]
        if old:
            sys.exit(f"{' and '.join(old)} are out of date: run python3 conformance/page.py")
        unproven = [s["name"] for s in found if not s.get("wrong")]
        if unproven:
            sys.exit(f"nothing proves that the suite can fail {', '.join(unproven)}: run cargo xtask conformance --wrong")
        return
    for path, text in written.items():
        path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
