"""Fewer planted samples and resamples than a real report takes: these tests are about the page."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from harness.analysis import planted, smoothed


@pytest.fixture(autouse=True, scope="session")
def few_planted_samples() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(planted, "TRIALS", 4)
        patch.setattr(smoothed, "RESAMPLES", 20)
        yield
