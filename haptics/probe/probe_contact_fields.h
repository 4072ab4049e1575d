// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/core/fields.h"
#include "artus/detail/haptics/probe/probe_contact.h"

namespace artus {

// The named members of ProbeContactParams and of all that is in it, for visit_fields
// (core/fields.h).

ARTUS_FIELDS(ProbeFootprint, length, width, columns_x, columns_y, elements);

ARTUS_FIELDS(ColumnParams, strain_limit, stop_stiffness, min_modulus);

ARTUS_FIELDS(ProbeContactParams, footprint, column, column_depth, max_indentation, gel,
             gel_friction, dry_friction, gel_gap, shear_stiffness);

}  // namespace artus
