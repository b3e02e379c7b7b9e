// SPDX-License-Identifier: LGPL-3.0-or-later
#include "libraries.h"

#include "bridge/remap_step.h"
#include "material/library.h"

namespace mmale
{
scene::Libraries libraries()
{
  return {.laws = material::law_infos(),
          .smoothers = bridge::smoothers(),
          .transports = bridge::transports(),
          .fields = {}};
}
} // namespace mmale
