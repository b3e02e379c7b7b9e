// SPDX-License-Identifier: LGPL-3.0-or-later
//
// The list of reconstructions. A new one is one file and one name here; the
// conformance tests walk this list.
#pragma once

#include "remap/choice.h"
#include "remap/interfaces/lvira.h"
#include "remap/interfaces/moment_of_fluid.h"
#include "remap/interfaces/swartz.h"
#include "remap/interfaces/youngs.h"

namespace remap
{
/// A reconstruction says what it looks at, and what it promises.
template <class R>
concept ReconstructionMethod = Named<R> and requires {
  { R::uses_centroids } -> std::convertible_to<bool>;
  { R::exact } -> std::convertible_to<bool>;
};

using Reconstructions =
    std::tuple<reconstruction::MomentOfFluid, reconstruction::Lvira,
               reconstruction::Swartz, reconstruction::Youngs>;
using Reconstruction = Choice<Reconstructions>;

static_assert([]<class... R>(std::tuple<R...>*)
              { return (ReconstructionMethod<R> and ...); }(
                  static_cast<Reconstructions*>(nullptr)));
} // namespace remap
