from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contactsim.errors import InputError
from contactsim.surfaces.measured import MeasuredLine
from contactsim.surfaces.self_affine import SelfAffine, realisation_seed
from contactsim.surfaces.shapes import Cylinder, Flat, Sinusoid
from contactsim.surfaces.statistics import rms_gradient, rms_height
from contactsim.surfaces.topography import Topography

THESIS = {"length": 160000.0, "long_cutoff": 20000.0, "short_cutoff": 39.0625, "rms_gradient": 1e-3}


def self_affine(hurst_exponent=0.8, seed=0, **changes):
    return SelfAffine(
        **(
            THESIS
            | {"hurst_exponent": hurst_exponent, "seed": realisation_seed(seed, "test", hurst_exponent, 0)}
            | changes
        )
    )


@pytest.mark.parametrize("amplitudes", ["gaussian", "fixed"])
@pytest.mark.parametrize("hurst_exponent", [0.0, 0.2, 0.8, 1.0])
def test_the_gradient_of_the_profile_is_exactly_the_one_asked_for(hurst_exponent, amplitudes):
    surface = self_affine(hurst_exponent, amplitudes=amplitudes)
    q = 2 * np.pi * np.arange(surface.modes + 1) / surface.length
    assert np.sqrt(2 * np.sum(q**2 * np.abs(surface.coefficients) ** 2)) == pytest.approx(1e-3, rel=1e-12)


@pytest.mark.parametrize("amplitudes", ["gaussian", "fixed"])
@pytest.mark.parametrize("hurst_exponent", [0.0, 0.2, 0.8, 1.0])
def test_the_height_of_the_profile_is_exactly_the_one_asked_for(hurst_exponent, amplitudes):
    surface = self_affine(hurst_exponent, amplitudes=amplitudes, rms_gradient=None, rms_height=10.0)
    assert rms_height(surface.heights(16384)) == pytest.approx(10.0, rel=1e-12)
    steep = self_affine(hurst_exponent, amplitudes=amplitudes, rms_gradient=surface.profile_rms_gradient)
    assert np.allclose(steep.coefficients, surface.coefficients, rtol=1e-12, atol=0)  # one profile, asked for twice


def test_the_height_of_a_surface_is_exactly_the_one_asked_for():
    surface = self_affine(rms_gradient=None, rms_height=3.0, dimensions=2, short_cutoff=5000.0)
    assert rms_height(surface.heights(128)) == pytest.approx(3.0, rel=1e-12)
    fine = surface.heights(1024)  # 32 points a wave: differences fall short of slopes by a part in a thousand
    assert rms_gradient(fine, 160000.0 / 1024) == pytest.approx(surface.profile_rms_gradient, rel=2e-3)


def test_the_gradient_of_a_profile_is_the_one_asked_for():
    assert self_affine().profile_rms_gradient == 1e-3


def test_differences_on_the_thesis_grid_miss_the_gradient_by_two_in_ten_thousand():
    heights = self_affine(0.2).heights(262144)
    assert rms_gradient(heights, 160000.0 / 262144) == pytest.approx(1e-3, rel=2.5e-4)


def test_a_finer_grid_samples_the_same_surface():
    coarse, fine = (self_affine().heights(points) for points in (16384, 65536))
    assert np.allclose(fine[::4], coarse, rtol=0, atol=1e-12 * np.abs(coarse).max())


def test_modes_lie_strictly_above_the_shortest_wavelength():
    assert self_affine().modes == 4095  # the text: zero at and below it
    assert self_affine(short_cutoff=39.0).modes == 4102


def test_a_shorter_cut_off_keeps_the_numbers_of_the_longer_waves():
    long, short = self_affine(short_cutoff=100.0), self_affine(short_cutoff=39.0625)
    ratio = short.coefficients[1 : long.modes + 1] / long.coefficients[1:]
    assert np.allclose(ratio, ratio[0], rtol=1e-12)  # one common factor, from the scaling of the gradient


def power_spectrum(heights):
    return np.abs(np.fft.rfft(heights)) ** 2


@pytest.mark.parametrize("hurst_exponent", [0.2, 0.8])
def test_the_spectrum_has_the_exponents_of_eq_3_10(hurst_exponent):
    density = np.mean(
        [
            power_spectrum(self_affine(hurst_exponent, seed=(1, member), amplitudes="fixed").heights(16384))[1:4096]
            for member in range(4)
        ],
        axis=0,
    )
    mode = np.arange(1, 4096)
    flat, sloped = mode < 8, mode >= 8
    assert np.allclose(density[flat], density[0], rtol=0.05)  # one scale a member, so the mean is not quite flat
    slope = np.polyfit(np.log(mode[sloped]), np.log(density[sloped]), 1)[0]
    assert slope == pytest.approx(-(1 + 2 * hurst_exponent), abs=0.01)


def test_gaussian_amplitudes_scatter_and_fixed_ones_do_not():
    q_power = {}
    for kind in ("gaussian", "fixed"):
        surface = self_affine(amplitudes=kind)
        mode = np.arange(8, surface.modes + 1)
        q_power[kind] = np.abs(surface.coefficients[8:]) ** 2 * mode ** (1 + 2 * 0.8)
    assert np.ptp(q_power["fixed"]) < 1e-9 * q_power["fixed"].mean()
    # |z|² of a complex normal number is exponential: its standard deviation is its mean
    assert np.std(q_power["gaussian"]) / np.mean(q_power["gaussian"]) == pytest.approx(1, abs=0.1)


def test_each_member_hurst_exponent_and_study_is_an_own_draw_and_repeats():
    labels = [("study", 0.8, 0), ("study", 0.8, 1), ("study", 0.2, 0), ("other", 0.8, 0)]
    first = [np.random.default_rng(realisation_seed(1, *label)).normal() for label in labels]
    assert len(set(first)) == 4
    assert first == [np.random.default_rng(realisation_seed(1, *label)).normal() for label in labels]


def test_the_numbers_of_a_seed_are_the_same_on_every_machine():
    assert np.random.default_rng(realisation_seed(2019, "rough_line", 0.8, 0)).normal() == pytest.approx(
        -0.06400166155843304, rel=1e-15
    )


def test_smooth_surfaces_have_their_shape():
    cylinder = Cylinder(4.0, 2.0).heights(8)
    assert cylinder[4] == 0
    assert cylinder[6] == pytest.approx(-(1.0**2) / 4)
    assert Sinusoid(1.0, 3.0, 2).heights(8) == pytest.approx([3, 0, -3, 0, 3, 0, -3, 0], abs=1e-15)
    assert np.array_equal(Flat(1.0, 2.0).heights(3), [2.0, 2.0, 2.0])


@pytest.mark.parametrize(
    ("build", "key"),
    [
        (lambda: self_affine(hurst_exponent=1.2), "hurst_exponent"),
        (lambda: self_affine(long_cutoff=2e5), "long_cutoff"),
        (lambda: self_affine(short_cutoff=2e4), "short_cutoff"),
        (lambda: self_affine(rms_gradient=0.0), "rms_gradient"),
        (lambda: self_affine(rms_gradient=None), "rms_gradient"),
        (lambda: self_affine(rms_height=10.0), "rms_gradient"),
        (lambda: self_affine(rms_gradient=None, rms_height=0.0), "rms_height"),
        (lambda: self_affine(rms_gradient=None, rms_height=float("nan")), "rms_height"),
        (lambda: self_affine(amplitudes="some"), "amplitudes"),
        (lambda: self_affine(length=float("inf")), "length"),
        (lambda: self_affine().heights(8190), "points"),
        (lambda: Cylinder(1.0, -1.0), "radius"),
        (lambda: Cylinder(0.0, 1.0), "length"),
        (lambda: Sinusoid(1.0, 0.0), "amplitude"),
        (lambda: Sinusoid(1.0, 1.0, 0), "periods"),
        (lambda: Sinusoid(1.0, 1.0, 2.5), "periods"),
        (lambda: Sinusoid(1.0, 1.0, True), "periods"),
        (lambda: Topography(np.arange(3.0), 1.0).heights(4), "points"),
        (lambda: MeasuredLine("no_such_file.npy"), "path"),
    ],
)
def test_an_impossible_surface_is_refused_by_key(build, key):
    with pytest.raises(InputError) as caught:
        build()
    assert caught.value.key == key


def test_a_measured_profile_is_detrended_and_made_periodic_by_the_named_options(tmp_path):
    np.save(tmp_path / "profile.npy", np.array([0.0, 2.0, 1.0, 5.0]))
    as_read = MeasuredLine(str(tmp_path / "profile.npy"), "none", "none", 2.0, "um")
    assert np.array_equal(as_read.heights(4), [0.0, 2000.0, 1000.0, 5000.0])
    assert as_read.lengths == (8.0,)
    mirrored = MeasuredLine(str(tmp_path / "profile.npy"), "mean", "mirror", 2.0)
    assert mirrored.points == 6
    assert mirrored.heights(6) == pytest.approx([-2, 0, -1, 3, -1, 0])


def test_without_cut_offs_the_long_one_is_the_period_and_the_short_one_a_512th():
    surface = SelfAffine(length=1e4, hurst_exponent=0.8, rms_gradient=0.1, seed=1)
    assert (surface.long_cutoff, surface.short_cutoff) == (1e4, 1e4 / 512)
    assert surface.modes == 511


def test_the_text_of_a_rough_surface_is_one_line_and_tells_all_that_differ_apart():
    surface = SelfAffine(length=1e4, hurst_exponent=0.8, rms_gradient=0.1, seed=1)
    assert repr(surface) == (
        "SelfAffine(length=10000.0, hurst_exponent=0.8, long_cutoff=10000.0, short_cutoff=19.53125, "
        "rms_gradient=0.1, seed=1)"
    )
    changes = {"seed": 2, "amplitudes": "fixed", "dimensions": 2, "low_pass_cutoff": 40.0, "rms_gradient": 0.1 + 1e-15}
    assert len({repr(replace(surface, **{key: value})) for key, value in changes.items()} | {repr(surface)}) == 6


@pytest.mark.parametrize("hurst_exponent", [0.2, 0.8])
@pytest.mark.parametrize("dimensions", [1, 2])
def test_fixed_amplitudes_have_the_spectrum_of_eq_3_10(dimensions, hurst_exponent):
    surface = SelfAffine(
        100.0, hurst_exponent, 25.0, 4.9, rms_gradient=0.1, amplitudes="fixed", dimensions=dimensions, seed=3
    )
    along = np.arange(surface.modes + 1)
    across = np.concatenate((along, -along[:0:-1]))
    waves = along if dimensions == 1 else np.hypot(across[:, None], along)
    drawn = (waves > 0) & (waves <= surface.modes)
    power = np.abs(surface.coefficients[drawn]) ** 2
    slope = -1 - 2 * hurst_exponent if dimensions == 1 else -2 * (1 + hurst_exponent)
    expected = np.maximum(waves[drawn] / 4, 1.0) ** slope  # flat down to the roll-off wavelength of a quarter
    np.testing.assert_allclose(power / power.max(), expected, rtol=1e-10)
