// SPDX-License-Identifier: LGPL-3.0-or-later
//
// The list of transport schemes. A new one is a few lines in schemes.h, a
// limiter in limiter.h, and one name here; the conformance tests walk this
// list.
#pragma once

#include "remap/choice.h"
#include "remap/transport/schemes.h"

namespace remap
{
/// A scheme says whether it uses gradients, which limiter, and what it
/// promises.
template <class S>
concept TransportScheme =
    Named<S> and Limiter<typename S::limiter> and requires {
      { S::linear } -> std::convertible_to<bool>;
      { S::bounded } -> std::convertible_to<bool>;
    };

using Schemes =
    std::tuple<scheme::DonorCell, scheme::LimitedLinear, scheme::SmoothExtrema,
               scheme::BarthJespersen, scheme::Venkatakrishnan, scheme::VanLeer,
               scheme::Minmod, scheme::Linear>;
using Scheme = Choice<Schemes>;
} // namespace remap
