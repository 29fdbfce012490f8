#pragma once

namespace lightwell {

/// Energy that lighting takes in a year, by the method of EN 15193-1:2017 (clause 6) for one zone.
struct EnergyUse {
  double watts = 0.0;           ///< P_n of all luminaires in the zone, W
  double area = 0.0;            ///< A, m^2, > 0
  double daylight_hours = 0.0;  ///< t_D, use in a year while there is daylight, h
  double night_hours = 0.0;     ///< t_N, use in a year without daylight, h
  double daylight = 1.0;        ///< F_D, share of the power that daylight leaves, [0,1]
  double occupancy = 1.0;       ///< F_O, share of the time in which somebody needs light, [0,1]
  double constant_illuminance = 1.0;  ///< F_C, share of the power with dimmed new lamps, (0,1]
  double standby_watts = 0.0;         ///< P_pc of controls outside the hours of use, W
  double charging_watts = 0.0;        ///< P_em of emergency luminaires that charge, W
  double charging_hours = 0.0;        ///< t_e of charging, h
};

/// Lighting energy numeric indicator, kWh/m^2 in a year of 8760 hours:
///
///     LENI = (W_L + W_P) / (1000 A)
///     W_L = P_n F_C F_O (t_D F_D + t_N)
///     W_P = P_pc (8760 - t_D - t_N) + P_em t_e
double energy_indicator(const EnergyUse& use);

/// F_C of lamps that are dimmed to the maintained illuminance all their lives: the mean of 1 and
/// the maintenance factor.
double constant_illuminance_factor(double maintenance_factor);

}  // namespace lightwell
