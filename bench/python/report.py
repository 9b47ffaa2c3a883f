"""Writes RESULTS.md and its plots from the newest results of each kind and machine: `python report.py`."""

from __future__ import annotations

import json
from pathlib import Path
from textwrap import shorten
from typing import Any

from common import FOLDER, RESULTS
from ratios import SLOW

OWN = "sweep-and-prune"


DATE = len("-2026-11-24")


def newest(kind: str) -> dict[str, dict[str, Any]]:
    """The newest results of a kind by the name of the machine, the newest first."""
    files = sorted(RESULTS.glob(f"{kind}-*.json"), key=lambda path: path.stem[-DATE:], reverse=True)
    found: dict[str, dict[str, Any]] = {}
    for file in files:
        found.setdefault(file.stem[len(kind) + 1 : -DATE], json.loads(file.read_text()))
    return found


def where(content: dict[str, Any]) -> str:
    """One paragraph: the machine, the day, the versions."""
    machine = content["machine"]
    load = "" if machine["load"] < 0.5 else f"; **other programs were running** (load average {machine['load']:.1f})"
    load = content.get("note", load)  # by hand, where the load average of the minute before says nothing
    versions = ", ".join(f"{name} {version}" for name, version in content["versions"].items())
    return (
        f"{machine['cpu']}, {machine['cores']} cores, {machine['memory_bytes'] / 2**30:.0f} GiB, {machine['system']}, "
        f"{content['date']}, revision {content['revision']}{load}. {versions}."
    )


def seconds(value: float) -> str:
    for unit, size in (("s", 1), ("ms", 1e-3), ("µs", 1e-6)):
        if value >= size:
            return f"{value / size:.3g} {unit}"
    return f"{value / 1e-9:.3g} ns"


def size(value: float | None) -> str:
    if value is None:
        return ""
    return f"{value / 1e9:.2f} GB" if value >= 1e9 else f"{value / 1e6:.0f} MB"


def with_torchvision(content: dict[str, Any], machine: str) -> list[str]:
    return ratios(content, machine, "Beside torchvision, in memory", "torchvision-")


def ratios(
    content: dict[str, Any], machine: str, title: str = "In memory", prefix: str = "", has_plots: bool = True
) -> list[str]:
    lines = [f"## {title}: {content['machine']['cpu']}", "", where(content), ""]
    lines += [
        "Time of each library over that of sweep-and-prune on one thread, in the same round (median; above 1 is slower), "
        "its own median time, and the most memory beyond its input.",
        "",
    ]
    tried = {name for case in content["cases"] for name in case["results"]} & SLOW.keys()
    if title == "In memory" and tried:
        limits = ", ".join(f"{name} beyond {SLOW[name]:,}" for name in sorted(tried))
        lines += [f"Not tried with more boxes, for which a round takes more than a minute: {limits}.", ""]
    for case in sorted({case["case"] for case in content["cases"]}):
        lines += [f"### {case}", "", "| boxes | found | library | ratio | time | memory |", "|--:|--:|---|--:|--:|--:|"]
        for one in (one for one in content["cases"] if one["case"] == case):
            boxes = f"{one['boxes']:,}" + (f", {one['scenes']} scenes" if "scenes" in one else "")
            for library, result in one["results"].items():
                lines.append(
                    f"| {boxes} | {one['found']:,} | {library} | {result['ratio']:.2f} "
                    f"| {seconds(result['median_seconds'])} | {size(result['peak_bytes'])} |"
                )
            for library, found in one["wrong"].items():
                shown = f"{found:,}" if isinstance(found, int) else found
                lines.append(f"| {boxes} | {one['found']:,} | {library} | finds {shown}: not timed | | |")
        lines += ["", *([f"![{case}]({plot(content, case, prefix, machine)})", ""] if has_plots else [])]
    return lines


def varied(content: dict[str, Any], machine: str) -> list[str]:
    return ratios(content, machine, "Many scenes of a kind, each once in a round", has_plots=False)


def plot(content: dict[str, Any], case: str, prefix: str, machine: str) -> str:
    """Draws ratios against the number of boxes."""
    import matplotlib

    matplotlib.use("svg")
    # The same results give the same file.
    matplotlib.rcParams["svg.hashsalt"] = "sweep-and-prune"
    import matplotlib.pyplot as plt
    from matplotlib.ticker import NullLocator

    figure, axes = plt.subplots(figsize=(8, 3.5), layout="constrained")
    cases = [one for one in content["cases"] if one["case"] == case]
    for library in dict.fromkeys(name for one in cases for name in one["results"]):
        points = [(one["boxes"], one["results"][library]["ratio"]) for one in cases if library in one["results"]]
        axes.plot(*zip(*points), marker="o", label=library)
    title = f"{case}: {prefix.rstrip('-')}" if prefix else case
    axes.set(xscale="log", yscale="log", xlabel="boxes", title=title)
    axes.set_ylabel("times as long as sweep-and-prune\n(lower is faster)")
    low, high = axes.get_ylim()
    # Over a wide range, more labels would collide.
    wide, narrow = (0.1, 0.5, 1, 5, 10, 50, 100, 500), (0.3, 0.5, 0.7, 1, 1.5, 2, 3, 5, 10, 20, 50, 100, 200)
    ticks = wide if high / low > 100 else narrow
    axes.set_yticks([tick for tick in ticks if low <= tick <= high])
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_locator(NullLocator())
    # Beside the curves, which it would hide.
    figure.legend(fontsize=8, loc="outside right upper")
    name = f"plots/{machine}/{prefix}{case.replace(', ', '-').replace(' ', '-')}.svg"
    (FOLDER / name).parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(FOLDER / name, metadata={"Date": None})
    plt.close(figure)
    return name


def disk(content: dict[str, Any], _: str) -> list[str]:
    limit = size(content["limit_bytes"])
    lines = [f"## From Parquet to Parquet: {content['machine']['cpu']}", "", where(content), "", f"The limit of memory is {limit}.", ""]
    header = "| boxes | library | time | processor time | ns a box and pair | memory | written | pairs |"
    lines += [header, "|--:|---|--:|--:|--:|--:|--:|--:|"]
    for case in content["cases"]:
        for library, runs in case["runs"].items():
            done = [run for run in runs if run["why_not"] is None]
            if not done:
                why = shorten(runs[-1]["why_not"], 70) if runs else "not run"
                lines.append(f"| {case['boxes']:,} | {library} | {why} | | | | | |")
                continue
            best = min(done, key=lambda run: run["seconds"])
            work = case["boxes"] + best["pairs"]
            busy = best.get("processor_seconds")
            lines.append(
                f"| {case['boxes']:,} | {library} | {seconds(best['seconds'])} | {seconds(busy) if busy else ''} "
                f"| {best['seconds'] / work * 1e9:.0f} | {size(max(run['peak_bytes'] for run in done))} "
                f"| {size(best['written_bytes'])} | {best['pairs']:,} |"
            )
    return [*lines, ""]


def main() -> None:
    lines = ["# Results of the Python package", "", "Written by `report.py`; do not edit.", ""]
    for kind, write in (("varied", varied), ("ratios", ratios), ("torchvision", with_torchvision), ("disk", disk)):
        for machine, content in newest(kind).items():
            lines += write(content, machine)
    Path(FOLDER / "RESULTS.md").write_text("\n".join(lines).rstrip() + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
