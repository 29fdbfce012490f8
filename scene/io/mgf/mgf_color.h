#pragma once

#include <Eigen/Core>
#include <span>

namespace lightwell {

/// A colour of an MGF file: linear RGB of luminance 1. Equal energy is (1, 1, 1).
using MgfColor = Eigen::Array3d;

/// Colour of CIE 1931 chromaticity, y > 0. Colours outside of the gamut of Rec. 709 lose their
/// negative parts.
MgfColor mgf_chromaticity(double x, double y);

/// Colour of a spectrum of equally spaced samples from `low` to `high` nm, linear between these and
/// 0 beyond: its means over 600-700, 500-600 and 400-500 nm.
MgfColor mgf_spectrum(double low, double high, std::span<const double> values);

/// Colour of a black body, kelvin > 0.
MgfColor mgf_black_body(double kelvin);

/// The colour with luminance 1. Throws InputError for a colour without luminance.
MgfColor with_unit_luminance(const MgfColor& color);

}  // namespace lightwell
