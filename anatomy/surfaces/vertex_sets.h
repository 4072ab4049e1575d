// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
// Boost 1.83 finds the property maps of plain pointers only where they are declared before it.
#include <boost/property_map/property_map.hpp>

#include <boost/pending/disjoint_sets.hpp>
