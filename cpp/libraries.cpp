// SPDX-License-Identifier: LGPL-3.0-or-later
#include "libraries.h"

#include "bridge/remap_step.h"
#include "material/closure.h"

namespace mmale
{
scene::Libraries libraries()
{
  return {.laws = material::law_infos(),
          .smoothers = bridge::smoothers(),
          .transports = bridge::transports(),
          .closures = material::closure_names(),
          .interfaces = bridge::interfaces(),
          .fields = {}};
}
} // namespace mmale
