// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/standard_view.h"

#include <algorithm>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/core/known_names.h"

namespace artus {

Result<StandardView> find_view(const CompiledJoint& joint, const std::string& name) {
  const auto names = item_names(joint.views);
  const auto found = find_name(names, name, "view", joint.name);
  ARTUS_TRY(found);
  return joint.views[*found];
}

const StandardView* view_at_default_probe(const CompiledJoint& joint) {
  const auto at = std::find_if(joint.views.begin(), joint.views.end(), [&](const StandardView& v) {
    return v.X_JP.matrix() == joint.X_JP_default.matrix();
  });
  return at == joint.views.end() ? nullptr : &*at;
}

}  // namespace artus
