"""The page of `make scaling` says what its figures say."""

import dataclasses
import json

from round_costs import DEAR

from tools.scaling import cases, findings, page, study
from tools.scaling.costs import TERMS, Costs


def of_still(workers, seconds, **gains):
    rows = []
    for count, time in zip(workers, seconds, strict=True):
        told = {"workers": count, "seconds": time, "speedup": 3600 / time, "efficiency": 3600 / time / count, "lost": 0}
        told |= {"fetched": 10**9, "parts": 500, "tasks": 600, "messages": 4000, "samples": 256.0, "workers_busy": 0.25}
        told |= {"rounds": [(2.0, 0, 0), (30.0, 16.0, 3)], "prepared": 2.0, "fetches": 100, "moved": 7, "scene_came": 12.0}
        told |= {"scheduler_busy": 0.5, "client": {"submit": 10.0, "join": 20.0}}
        rows.append(told | {"gains": dict.fromkeys(TERMS, 0.01) | gains})
    return rows


def test_the_largest_term_is_named():
    row = of_still([10], [400.0], client=0.3, network=0.06)[0]
    assert study.limits(row) == ["client", "network"] and study.limit(row) == "client, 30 %"
    assert study.limit(of_still([1], [3600.0])[0]) == "none but the samples"


def test_the_page_tells_where_it_ends(tmp_path, monkeypatch):
    told = {"scene": "s", "pilot_seconds": 1.0, "sample_seconds": 1e-6, "threads": 2}
    rows = of_still([1, 60, 1000], [3600.0, 100.0, 200.0], client=0.3)
    figures = {
        "machine": {"processor": "a processor", "processors": 2, "load": 0.5},
        "commit": "abc",
        "quick": False,
        "costs": dataclasses.asdict(DEAR),
        "told": told | {"many_workers": 9, "submit_of_many": [0, 0, 0]},
        "compared": [{"workers": 2, "seconds": 10.0, "predicted": 11.0, "tasks": 20, "predicted_tasks": 21}],
        "stills": [{"letter": "A", "name": cases.BY_LETTER["A"].name, "rows": rows}],
    }
    page.write(figures, tmp_path)
    text = (tmp_path / "scaling.md").read_text()
    assert "efficiency is at least 50 % up to 60 workers. 60 workers are the fastest: 100 s, 36.0 times as fast as one" in text
    assert "Shares of that time: client 30 %." in text and "1000 workers take 200 s." in text
    assert "| A | 60 | 100 s | 60 | 100 s | 36.0 | client, 30 % |" in text and "| 60 | 100 s | 36.0 | 60 % | 1000 |" in text
    assert "| A | 1000 | 25 % | 50 % | 5 % | 0 % | 0 % | 10 % | 0 % |" in text
    # A quarter of 60 times 100 s for 500 parts. A part takes 1.2 tasks of 1 ms; 2 ms of the client, 1.5 ms of scheduler and
    # worker, and four messages of 0.1 ms, or 0.2 ms.
    assert "5.0 parts at a time, 1.2 tasks and 3.00 s of rendering for each, 588 or 2143 workers." in text
    # Half of 100 s for 600 tasks.
    assert (
        "A 83.3 ms for each of 600 tasks, 120 workers. The scheduler is busy for at most 50 % of the time (A, 1 worker)."
        in text
    )
    assert "A picture loses at most 0 workers (A, 1 worker)." in text
    assert "A 1 of 2, with 6.2 % of the samples after 28 % of the time." in text
    assert "A 12 s with 1000 workers." in text
    monkeypatch.setattr(page, "PLACE", tmp_path / "SCALING.md")
    monkeypatch.setattr(page, "CHART", tmp_path / "chart.png")
    (tmp_path / "scaling.png").write_bytes(b"chart")
    page.publish(tmp_path)
    assert "(../../scenes/scaling.png)" in (tmp_path / "SCALING.md").read_text()
    assert (tmp_path / "chart.png").read_bytes() == b"chart"


def test_costs_survive_their_file(tmp_path):
    DEAR.write(tmp_path / "costs.json")
    assert Costs.of(json.loads((tmp_path / "costs.json").read_text())) == DEAR


def test_a_minute_is_told_as_such():
    assert [findings.seconds(value) for value in (0.26, 59.6, 3600.0)] == ["0.3 s", "60 s", "60 min"]
