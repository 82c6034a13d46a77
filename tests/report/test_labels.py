"""Curves are told apart by what they differ in, and by no more."""

from __future__ import annotations

import json

from harness.analysis import Key
from harness.report.labels import curve_labels


def key(family: str, domain: str = "kernel", **params: float) -> Key:
    return Key(family, json.dumps(params, sort_keys=True), domain, "smallest", "fast")


def test_a_label_names_what_differs_within_the_family() -> None:
    keys = [key("zigzag", tilt=0.2), key("zigzag", tilt=0.5), key("star"), key("star", "interior")]
    assert curve_labels(keys) == [
        "zigzag, tilt = 0.2",
        "zigzag, tilt = 0.5",
        "star, kernel",
        "star, interior",
    ]


def test_noise_is_one_number_relative_to_a_power_of_n() -> None:
    noises = [(0.0, 3), (1e-6, 2), (1e-6, 1), (1e-6, 0), (0.001, 11)]
    keys = [key("zigzag", noise=noise, noise_power=power) for noise, power in noises]
    assert curve_labels(keys) == [
        "zigzag, noise = 0",
        "zigzag, noise = 1e-06/n²",
        "zigzag, noise = 1e-06/n",
        "zigzag, noise = 1e-06",
        "zigzag, noise = 0.001/n¹¹",
    ]


def test_the_power_of_no_noise_is_named_only_if_nothing_else_tells_apart() -> None:
    keys = [key("zigzag", noise=0.0, noise_power=p, tilt=t) for p, t in ((2, 0.2), (3, 0.5))]
    assert curve_labels(keys) == ["zigzag, tilt = 0.2", "zigzag, tilt = 0.5"]
    keys = [key("zigzag", noise=0.0, noise_power=p) for p in (2, 3)]
    assert curve_labels(keys) == ["zigzag, noise_power = 2", "zigzag, noise_power = 3"]
