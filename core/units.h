// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

namespace artus {

inline constexpr double kMillimetre = 1e-3;              // m
inline constexpr double kCubicCentimetre = 1e-6;         // m^3
inline constexpr double kDegree = 0.017453292519943295;  // rad
inline constexpr double kTwoPi = 6.283185307179586;      // rad, a whole turn
/// One neper of amplitude in decibel: 20 / ln 10.
inline constexpr double kDecibelPerNeper = 8.685889638065035;  // dB/Np
/// The speed every clinical scanner assumes when it turns time into depth.
inline constexpr double kDisplaySpeedOfSound = 1540.0;  // m/s

}  // namespace artus
