// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/core/fields.h"
#include "artus/detail/haptics/probe/probe_contact.h"

namespace artus {

// The named members of ProbeContactParams and of all that is in it, for visit_fields
// (core/fields.h).

template <Like<ProbeFootprint> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [length, width, columns_x, columns_y, elements] = params;
  visit("length", length);
  visit("width", width);
  visit("columns_x", columns_x);
  visit("columns_y", columns_y);
  visit("elements", elements);
}

template <Like<ColumnParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [strain_limit, stop_stiffness, min_modulus] = params;
  visit("strain_limit", strain_limit);
  visit("stop_stiffness", stop_stiffness);
  visit("least_modulus", min_modulus);
}

template <Like<ProbeContactParams> P, class F>
void fields_of(P& params, F&& visit) {
  auto& [footprint, column, depth, max_indentation, gel, gel_friction, dry_friction, gel_gap,
         shear_stiffness] = params;
  visit("footprint", footprint);
  visit("column", column);
  visit("column_depth", depth);
  visit("max_indentation", max_indentation);
  visit("gel", gel);
  visit("gel_friction", gel_friction);
  visit("dry_friction", dry_friction);
  visit("gel_gap", gel_gap);
  visit("shear_stiffness", shear_stiffness);
}

}  // namespace artus
