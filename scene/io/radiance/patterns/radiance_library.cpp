// Formulas behind the names that RADIANCE's function files define. Names and arguments are those of
// its reference manual; Dx, Dy and Dz are the direction of a ray towards the light, A1, A2, ... the
// arguments of the pattern.
#include "scene/io/radiance/patterns/radiance_library.h"

namespace lightwell {
namespace {

constexpr std::string_view general = R"(
  DEGREE = PI / 180; FTINY = 1e-7;
  bound(low, x, high) = max(low, min(x, high));
  clip(x) = bound(0, x, 1); noneg(x) = max(x, 0); noop(x) = x;
  Acos(x) = acos(bound(-1, x, 1)); Asin(x) = asin(bound(-1, x, 1));
  Atan2(y, x) = atan2(y, x); Exp(x) = exp(x); Sqrt(x) = sqrt(max(x, 0));
  sgn(x) = if(x, 1, if(-x, -1, 0)); frac(x) = x - floor(x);
  and(a, b) = if(a, b, a); or(a, b) = if(a, a, b); not(a) = if(a, -1, 1);
  inside(low, x, high) = and(x - low, high - x);
  mod(x, period) = x - period * floor(x / period);
  tri(x, half) = abs(half - mod(x - half, 2 * half));
  linterp(t, a, b) = a + t * (b - a);
  red(r, g, b) = noneg(r); green(r, g, b) = noneg(g); blue(r, g, b) = noneg(b);
  grey(r, g, b) = noneg(.265074126 * r + .670114631 * g + .064811243 * b);
)";

// Skies of gensky. A1: 1 clear (Kittler 1967; CIE 1973), 2 overcast (Moon & Spencer 1942), 3
// uniform, 4 intermediate (Nakamura, Oki & Hayashi 1985). A2: radiance of the zenith, A3: of the
// ground, A4: distribution at the zenith, A5 to A7: towards the sun. Sky and ground pass into each
// other about the horizon.
constexpr std::string_view sky_of_gensky = R"(
  cosgamma = Dx * A5 + Dy * A6 + Dz * A7; gamma = Acos(cosgamma);
  eta = Acos(Dz); zt = Acos(A7);
  above = (Dz + 1.01) ^ 10;
  wmean(a, x, b, y) = (a * x + b * y) / (a + b);
  cleargradation = if(Dz - .01, 1 - exp(-.32 / Dz), 1);
  sunnysky = A2 / A4 * cleargradation * (.91 + 10 * exp(-3 * gamma) + .45 * cosgamma ^ 2);
  cloudysky = A2 * (1 + 2 * Dz) / 3;
  unifsky = A2;
  intersky = A2 / A4 * exp(-.563 * gamma * (.812 + (2.629 - eta) * (1.562 - zt)))
      * (6.37 - eta + sin(4.396 - 2.6 * zt) * (3.12 + 1.35 * sin(5.631 - 3.59 * eta))) / 2.326;
  skybr = wmean(above, select(A1, sunnysky, cloudysky, unifsky, intersky), 1 / above, A3);
)";

// Skies of gendaylit (Perez, Seals & Michalsky 1993). A1: normalisation, A2: radiance of the
// ground, A3 to A7: coefficients a to e, A8 to A10: towards the sun.
constexpr std::string_view sky_of_gendaylit = R"(
  cosgamma = Dx * A8 + Dy * A9 + Dz * A10; gamma = Acos(cosgamma);
  eta = Acos(Dz); zt = Acos(A10);
  above = (Dz + 1.01) ^ 10;
  wmean(a, x, b, y) = (a * x + b * y) / (a + b);
  intersky = A1 * (1 + A3 * exp(A4 / max(Dz, .01)))
      * (1 + A5 * exp(A6 * gamma) + A7 * cosgamma ^ 2);
  skybright = wmean(above, intersky, 1 / above, A2);
)";

// Distributions of luminaires, in degrees: theta from -z, phi from +x towards +y. A1: multiplier;
// dimensions of a box (A2 to A4) or of a cylinder (A2: diameter, A3: height) that shines.
constexpr std::string_view luminaires = R"(
  src_theta = Acos(Dz) / DEGREE;
  src_phi = mod(atan2(-Dy, -Dx) / DEGREE, 360);
  src_phi2 = tri(src_phi, 180); src_phi4 = tri(src_phi, 90);
  srcB_vert = atan2(-Dx, Dz) / DEGREE; srcB_horiz = atan2(Dy, Dz) / DEGREE;
  srcB_vert2 = abs(srcB_vert); srcB_horiz2 = abs(srcB_horiz);
  boxprojection = abs(Dx) * A3 * A4 + abs(Dy) * A2 * A4 + abs(Dz) * A2 * A3;
  cylprojection = A2 * A3 * Sqrt(1 - Dz * Dz) + PI / 4 * A2 * A2 * abs(Dz);
  corr(v) = if(AC - .5, A1, 1) * v;
  flatcorr(v) = corr(v) / Rdot;
  boxcorr(v) = A1 * v / boxprojection;
  lboxcorr(v) = boxcorr(v);
  cylcorr(v) = A1 * v / cylprojection;
)";

// Distributions that mkillum writes: cosine of the altitude, or its square over a hemisphere with
// the axes A1 to A9, and azimuth.
constexpr std::string_view illums = R"(
  norm_rad(r) = if(r, r, r + 2 * PI);
  il_alt = Dz; il_azi = norm_rad(atan2(Dy, Dx));
  il_alth = (Dx * A7 + Dy * A8 + Dz * A9) ^ 2;
  il_azih = norm_rad(atan2(-Dx * A4 - Dy * A5 - Dz * A6, -Dx * A1 - Dy * A2 - Dz * A3));
)";

}  // namespace

std::string_view radiance_library(std::string_view file) {
  if (file == "rayinit.cal") return general;
  if (file == "skybright.cal") return sky_of_gensky;
  if (file == "perezlum.cal") return sky_of_gendaylit;
  if (file == "source.cal") return luminaires;
  if (file == "illum.cal") return illums;
  return {};
}

}  // namespace lightwell
