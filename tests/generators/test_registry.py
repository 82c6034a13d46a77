"""What every family promises: documentation, reproducibility, clear refusals."""

import hashlib
import inspect

import numpy as np
import pytest

from generators import FAMILIES, GROWTHS, GeneratorError, generate

NAMES = sorted(FAMILIES)
# SHA-256 of the little-endian coordinates at seed 7: the stated contract is that these bits
# never change.  n = 24 (figure-2: 3).
FINGERPRINTS: dict[str, str] = {
    "cavity": "73a925c10911de261b90df60065b14b8",
    "control-constant": "6d28b7a77b221884fc0870b400de7216",
    "control-linear": "c09e70a8679f0d7d3f5fc7d4abb3cfce",
    "convex-circle": "273a3b04c1e0ce89a459a476774748a8",
    "convex-valtr": "561a3f511930eefb711aaa8e27350a44",
    "convex-weave": "f988ffa2bc4425c6433996f209530f99",
    "figure-2": "15390a47adcdfda8454bfe3082fc4534",
    "grid": "328246b7046ead31ff24e649eb62bf86",
    "near-regular": "67ed2d000b868ea29778290832a77c9b",
    "segments": "989b402046a58accca1fc98f87dc2f85",
    "star": "cca0f072a90969f132e03a21f7c0cef6",
    "star-fat": "aa57dd7456361060da5650e27c7b4bd3",
    "zigzag": "b62e3f0723af0624b635d2b30a7786a5",
}


def size(name: str) -> int:
    return min(24, FAMILIES[name].largest)


def fingerprint(name: str, n: int, seed: int) -> str:
    coordinates = generate(name, n, seed).coordinates
    return hashlib.sha256(coordinates.astype("<f8").tobytes()).hexdigest()[:32]


@pytest.mark.parametrize("name", NAMES)
def test_a_family_is_documented(name):
    family = FAMILIES[name]
    doc = inspect.getdoc(family.build) or ""
    assert family.name == name
    assert family.summary
    assert family.source
    assert family.growth in GROWTHS
    assert "O(" in doc or family.largest == 3
    assert "Source:" in doc or name.startswith("control")
    signature = inspect.signature(family.build).parameters
    assert list(signature) == ["n", "seed", *(p.name for p in family.parameters)]
    for parameter in family.parameters:
        assert parameter.help
        assert signature[parameter.name].default == parameter.default
        assert parameter.read(name, parameter.default) == parameter.default
        assert type(parameter.default) is parameter.type


def test_there_is_a_control_for_each_kind_of_growth():
    controls = {family.growth for family in FAMILIES.values() if family.control}
    assert controls == {"1", "n", "n^2"}


@pytest.mark.parametrize("name", NAMES)
def test_the_coordinates_never_change(name):
    assert fingerprint(name, size(name), 7) == FINGERPRINTS[name]


@pytest.mark.parametrize("name", NAMES)
def test_an_instance_knows_what_it_is(name):
    family = FAMILIES[name]
    made = generate(name, size(name), 3)
    assert made.n == size(name)
    assert made.kind == family.kind
    assert made.seed == 3
    assert made.coordinates.shape == ((made.n, 2) if made.kind == "polygon" else (made.n, 2, 2))
    assert made.coordinates.dtype == np.float64
    assert np.isfinite(made.coordinates).all()
    assert made.params == {p.name: p.default for p in family.parameters}
    with pytest.raises(ValueError, match="read-only"):
        made.coordinates[0] = 0.0
    # The function itself serves as well as the registry.
    assert np.array_equal(family.build(made.n, 3), made.coordinates)


@pytest.mark.parametrize("name", NAMES)
def test_the_seed_matters_exactly_if_the_family_is_random(name):
    params = {"variant": "generic"} if name == "grid" else {}
    one, two = (generate(name, size(name), seed, **params).coordinates for seed in (0, 1))
    assert np.array_equal(one, two) is not FAMILIES[name].random


@pytest.mark.parametrize("name", NAMES)
def test_sizes_are_checked(name):
    family = FAMILIES[name]
    for n in (family.smallest - 1, 0, -5, family.largest + 1):
        with pytest.raises(GeneratorError, match=f"^{name}: n = {n} must be"):
            generate(name, n)
    if family.even:
        with pytest.raises(GeneratorError, match=r"must be even between"):
            generate(name, family.smallest + 1)
    for n in (4.0, "4", None, True):
        with pytest.raises(GeneratorError, match=r"must be an integer"):
            family.check(n, {})
    family.check(family.smallest, {})


@pytest.mark.parametrize("name", NAMES)
def test_parameters_are_checked(name):
    family = FAMILIES[name]
    for parameter in family.parameters:
        for value in ("nonsense", None, True, [1], float("nan"), float("inf"), "1e999"):
            with pytest.raises(GeneratorError, match=f"^{name}: {parameter.name} = .* must be"):
                generate(name, size(name), **{parameter.name: value})
        if parameter.allowed:
            for value in (parameter.allowed.low - 1, parameter.allowed.high + 1):
                with pytest.raises(
                    GeneratorError, match=rf"{parameter.name} = .* is outside [\[(]"
                ):
                    generate(name, size(name), **{parameter.name: value})
        as_text = generate(name, size(name), **{parameter.name: str(parameter.default)})
        assert as_text.params[parameter.name] == parameter.default
    with pytest.raises(GeneratorError, match=rf"^{name} has no parameter 'sparkle'"):
        generate(name, size(name), sparkle=1)


def test_messages_are_one_line_and_suggest():
    with pytest.raises(GeneratorError, match=r"unknown family 'zigzg' \(did you mean 'zigzag'\?\)"):
        generate("zigzg", 8)
    with pytest.raises(GeneratorError, match=r"has no parameter 'tlt' \(did you mean 'tilt'\?\)"):
        generate("zigzag", 8, tlt=3)
    with pytest.raises(GeneratorError, match=r"seed = -1 must not be negative"):
        generate("zigzag", 8, seed=-1)
    with pytest.raises(GeneratorError, match=r"seed = 0.5 must be an integer"):
        generate("zigzag", 8, seed=0.5)
    with pytest.raises(GeneratorError, match=r"noise_power = 1.5 must be an integer"):
        generate("zigzag", 8, noise_power=1.5)


@pytest.mark.parametrize(
    ("name", "n", "params", "message"),
    [
        ("near-regular", 3, {"angular": 0.9}, "angular = 0.9 must be at most 0.47 for n = 3"),
        ("near-regular", 6, {"radial": 3.0}, "radial = 3 must be at most 1.7"),
        ("star-fat", 3, {"disc": 0.5}, "disc = 0.5 must be at most"),
        ("zigzag", 8, {"noise": 2.0, "noise_power": 1}, "noise = 2 means .* at most 1/n = 0.125"),
        ("convex-weave", 8, {"noise": 40.0}, r"noise = 40 means .* at most \(1 - delta\)"),
        ("convex-weave", 10**6, {"delta": 0.999999}, "less height than rounding needs"),
    ],
)
def test_infeasible_combinations_are_refused(name, n, params, message):
    with pytest.raises(GeneratorError, match=message):
        FAMILIES[name].check(n, params)
    with pytest.raises(GeneratorError, match=message):
        generate(name, n, **params)


def test_a_huge_seed_is_a_seed():
    assert fingerprint("star", 10, 2**64 - 1) != fingerprint("star", 10, 2**32 - 1)
