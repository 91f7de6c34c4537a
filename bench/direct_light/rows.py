"""Reads CSV tables and interpolates their curves."""

import csv
import math

FIXED = ("fixed single", "fixed packets")


def _value(text):
    try:
        return float(text)
    except ValueError:
        return text


def read(path):
    with open(path, newline="") as file:
        return [{k: _value(v) for k, v in row.items()} for row in csv.DictReader(file)]


def scenes(table):
    """Returns (scene, view) pairs in order of appearance."""
    return list(dict.fromkeys((r["scene"], r["view"]) for r in table))


def curve(table, scene, view, method, error="rms_visible", cost="ns_pair"):
    """Returns [(error, cost)] in the order of settings."""
    return [(r[error], r[cost]) for r in table
            if (r["scene"], r["view"], r["method"]) == (scene, view, method)]


def cost_at(points, error):
    """Returns (cost, mark) of reaching `error`, by straight lines in logarithmic scales between
    neighbouring settings. Mark "<=": even the cheapest setting is more accurate, and this is its cost.
    None: no setting is that accurate."""
    enough = [c for e, c in points if e <= error]
    if not enough:
        return None, "beyond"
    best, mark = min(enough), "<="
    for (e0, c0), (e1, c1) in zip(points, points[1:]):
        if min(e0, e1) <= error < max(e0, e1):
            share = math.log(error / e0) / math.log(e1 / e0)
            cost = math.exp(math.log(c0) + share * math.log(c1 / c0))
            if cost <= best:
                best, mark = cost, ""
    return best, mark


def best_fixed(table, scene, view, error, quantity="rms_visible", cost="ns_pair"):
    """Returns (cost, method) of the faster of the two ways to cast a fixed number of rays."""
    found = []
    for method in FIXED:
        c, _ = cost_at(curve(table, scene, view, method, quantity, cost), error)
        if c is not None:
            found.append((c, method))
    return min(found) if found else (None, "beyond")
