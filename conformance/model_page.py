"""The pictures and numbers of model.py as a section of the page, and in Markdown."""

import html
import json
from pathlib import Path

FILE = Path(__file__).resolve().parent / "results/model.json"
LEVELS = {"bits": "● equal in bits", "angle": "◐ within 0.1°", "seams": "○ signs and seams right", "fails": "✕ signs or seams wrong"}
# Programs that do not claim to compute MikkTSpace cannot be wrong about it.
OF_OTHER_METHODS = {**LEVELS, "seams": "○ signs and seams equal", "fails": "◇ signs or seams differ"}
COUNTS = {"wrong_signs": "corners with the other sign", "zero": "zero tangents", "non_finite": "tangents not finite", "missing_splits": "vertices on the seam not split"}


def read():
    return json.loads(FILE.read_text(encoding="utf-8"))


def parts(made, reference, is_another_method):
    """The reference with the runs that have its bits, the other runs that claim MikkTSpace, and those of other methods; the last two from the most equal corners to the fewest."""
    ordered = sorted(made["runs"], key=lambda run: (run["id"] != reference, not run.get("ours"), -run["equal"], run["wrong_signs"], run["name"]))
    same = [run for run in ordered if run["equal"] == run["corners"]]
    different = [run for run in ordered if run not in same]
    return same, [run for run in different if not is_another_method(run)], [run for run in different if is_another_method(run)]


def name(run):
    return f"{run['name']} {run['version']}"


def sentence(made):
    """What is drawn, in words that Markdown and HTML share."""
    model = made["model"]
    return (
        f"The back and the sides of a guitar ({model['triangles']:,} triangles) whose UVs are mirrored along the middle, with test bumps and the tangents that each program "
        f"gave, in one view and one light. {model['on_seam']} vertices lie on the mirrored seam; MikkTSpace gives each of them two tangents, which "
        f"needs two vertices. As in a file without tangents, the programs got them as one. Numbers are of the {made['runs'][0]['corners']:,} corners, against mikktspace.c."
    )


def credit(made):
    model = made["model"]
    return f"{model['name']} by {model['author']}, {model['licence']}"


def numbers(run):
    """What was measured of a run, as short phrases."""
    if run["equal"] == run["corners"]:
        return []
    found = [f"{run['equal']:,} corners equal in bits"]
    if run["median_angle"] is not None:
        found.append(f"angles: median {angle(run['median_angle'])}, largest {angle(run['largest_angle'])}")
    return found + [f"{run[key]:,} {words}" for key, words in COUNTS.items() if run[key]]


def angle(degrees):
    return "under 0.001°" if 0 < degrees < 0.001 else f"{degrees:.3g}°"


def equals(same):
    return f"Equal to {same[0]['name']} in every bit, and in the picture: {'; '.join(map(name, same[1:]))}."


def missing(made):
    """A sentence about the programs of others that gave no result; none if all did."""
    absent = [f"{run['name']} ({run['reason']})" for run in made["missing"] if not run.get("ours")]
    return [f"Not drawn, because it did not run here: {'; '.join(absent)}."] if absent else []


def figure(run, levels=LEVELS):
    title = html.escape(name(run))
    breakable = title.replace("::", "::<wbr>").replace("_", "_<wbr>").replace(".", ".<wbr>")
    words = "".join(f"<br>{html.escape(phrase)}" for phrase in numbers(run))
    css_class = run["level"] if levels is LEVELS else "other"
    return f'<figure class="{css_class}"><img src="model/{run["picture"]}" width="300" height="260" alt="The model with the tangents of {title}"><figcaption><strong>{breakable}</strong><br>{levels[run["level"]]}{words}</figcaption></figure>'


def section(made, same, claiming, others, words_of_others):
    """The section of the page."""
    source = html.escape(made["model"]["source"])
    lines = [f'<p>{html.escape(sentence(made))} The model: <a href="{source}">{html.escape(credit(made))}</a>. Drawn on {made["date"]}.</p>']
    lines += [f"<p>{html.escape(equals(same))}</p>", '<div class="strip">', *map(figure, [same[0], *claiming]), "</div>"]
    lines += [f"<p>Other methods. {html.escape(words_of_others)}</p>", '<div class="strip">', figure(same[0]), *(figure(run, OF_OTHER_METHODS) for run in others), "</div>", *(f"<p>{html.escape(sentence)}</p>" for sentence in missing(made))]
    return "\n".join(lines)


def markdown(made, same, claiming, others, words_of_others):
    """The lines in Markdown."""
    lines = ["## On a real model", "", f"{sentence(made)} The model: [{credit(made)}]({made['model']['source']}). Drawn on {made['date']} by `conformance/model.py`.", ""]
    lines += [equals(same), "", *rows([same[0], *claiming]), "", f"Other methods. {words_of_others}", "", *rows(others, OF_OTHER_METHODS)]
    return lines + [line for sentence in missing(made) for line in ("", sentence)]


def rows(runs, levels=LEVELS):
    lines = ["| picture | numbers |", "|---|---|"]
    for run in runs:
        words = "; ".join([levels[run["level"]], *numbers(run)])
        lines.append(f"| ![The model with the tangents of {name(run)}](../conformance/results/model/{run['picture']}) | **{name(run)}**: {words} |")
    return lines
