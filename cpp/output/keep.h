// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "archive.h"
#include "clock.h"
#include "curves.h"
#include "fields.h"
#include <vector>

/// What a run has told so far, into a checkpoint and out of it.
namespace mmale::output
{
/// What the timers have seen, in a run that goes on.
void keep(Archive& archive, Clock& clock, std::vector<Timing> timings);

/// The rows of curves.csv; a file of them is written anew.
/// @throws std::runtime_error if the checkpoint has other curves
void keep(Archive& archive, Curves& curves);

/// Outputs of fields that a checkpoint knows of.
void keep(Archive& archive, std::vector<FieldOutput>& outputs);
} // namespace mmale::output
