"""From rows to curves: grouping, sizes, failures, seeds; invariance under the order of rows."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from harness.analysis import HEADLINES, STATISTICS, analyse_group, split
from harness.errors import UserError
from tests.analysis.frames import fail, rows


def noisy(family: str = "star", replicates: int = 5, **more: object) -> pd.DataFrame:
    return rows(family, lambda n, rng: n * rng.lognormal(0, 0.3), replicates=replicates, **more)


def by_identity(frame: pd.DataFrame) -> dict[object, object]:
    return {group.key: analyse_group(group) for group in split(frame)}


def same_curves(one: object, other: object) -> bool:
    for headline in HEADLINES:
        for statistic in STATISTICS:
            a, b = one.curves[headline, statistic], other.curves[headline, statistic]
            if a.observed.tolist() != b.observed.tolist() or a.verdict != b.verdict:
                return False
            if a.power != b.power:
                return False
    return True


def test_groups_are_split_by_identity_and_nothing_else() -> None:
    frame = pd.concat([noisy(), noisy(domain="interior"), noisy(params={"a": 1}), noisy("zigzag")])
    keys = [group.key for group in split(frame)]
    assert len(set(keys)) == len(keys) == 4
    assert keys == sorted(keys)
    assert len({key.slug for key in keys}) == 4
    assert all(len(group.sizes) == 6 for group in split(frame))


def test_order_of_rows_and_other_groups_change_nothing() -> None:
    alone = noisy()
    mixed = pd.concat([alone, noisy("zigzag", seed=3)]).sample(frac=1.0, random_state=7)
    one, other = by_identity(alone), by_identity(mixed)
    (key,) = one
    assert same_curves(one[key], other[key])


def test_adding_replicates_at_or_below_the_maximum_leaves_the_maximum() -> None:
    frame = noisy()
    low = frame.copy()
    low["replicate"] += 100
    low["vertices"] = 0
    (one,), (other,) = by_identity(frame).values(), by_identity(pd.concat([frame, low])).values()
    curve = ("vertices", "maximum")
    assert one.curves[curve].observed.tolist() == other.curves[curve].observed.tolist()


def test_failed_tasks_are_counted_as_unseen_and_invalid_ones_are_not() -> None:
    frame = noisy()
    frame = fail(frame, (frame.n == 32) & (frame.replicate == 0), "timeout")
    frame = fail(frame, (frame.n == 24) & (frame.replicate == 1), "invalid")
    (analysed,) = by_identity(frame).values()
    sizes = {size.n: size for size in analysed.group.sizes}
    assert sizes[32].failures == {"timeout": 1}
    assert (sizes[32].unseen, sizes[24].unseen) == (1, 0)
    maximum = analysed.curves["vertices", "maximum"]
    assert maximum.censored == (False,) * 5 + (True,)
    assert maximum.bounds[5].low == maximum.observed[5]
    assert maximum.bounds[5].high == float("inf")


def test_a_size_without_any_count_is_left_out_of_the_curve_but_kept_in_the_group() -> None:
    frame = noisy()
    (analysed,) = by_identity(fail(frame, frame.n == 32, "memory")).values()
    assert [size.n for size in analysed.group.sizes] == [6, 8, 12, 16, 24, 32]
    assert analysed.curves["vertices", "maximum"].n.tolist() == [6, 8, 12, 16, 24]


def test_a_group_of_failures_alone_is_analysed_without_a_curve() -> None:
    frame = noisy()
    (analysed,) = by_identity(fail(frame, frame.n > 0, "error")).values()
    assert not analysed.group.seen
    assert analysed.curves["cells", "median"].verdict.label == "not decided"


def test_the_axis_is_the_number_of_segments() -> None:
    frame = noisy()
    frame["segments"] = frame["n"] - 1
    (analysed,) = by_identity(frame).values()
    assert analysed.curves["edges", "median"].n.tolist() == [5, 7, 11, 15, 23, 31]


def test_ratios_times_models_give_the_counts_back() -> None:
    (analysed,) = by_identity(noisy()).values()
    curve = analysed.curves["vertices", "median"]
    assert curve.ratios["1"].tolist() == curve.observed.tolist()
    assert curve.ratios["n^2"] * curve.n**2 == pytest.approx(curve.observed)
    assert curve.ratios["n log n"] * curve.n * np.log(curve.n) == pytest.approx(curve.observed)


def test_declared_growth_makes_a_control_only_with_default_parameters() -> None:
    from generators import FAMILIES

    family = FAMILIES["zigzag"]
    defaults = {parameter.name: parameter.default for parameter in family.parameters}
    (plain,) = by_identity(noisy("zigzag", params=defaults)).values()
    assert plain.declared.model.name == family.growth
    assert plain.declared.defaults
    name = family.parameters[0].name
    (other,) = by_identity(noisy("zigzag", params={**defaults, name: 7})).values()
    assert not other.declared.defaults
    assert other.declared.changed == (name,)
    for frame in (noisy("zigzag", domain="interior"), noisy("unheard-of")):
        (analysed,) = by_identity(frame).values()
        assert analysed.declared is None


def test_no_rows_and_missing_columns_are_user_errors() -> None:
    with pytest.raises(UserError, match="no rows"):
        list(split(noisy().iloc[:0]))
    with pytest.raises(UserError, match="'vertices'"):
        list(split(noisy().drop(columns="vertices")))
