// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <mpi.h>

namespace mmale::output
{
/// Do something on the first rank only, and fail on all of them.
///
/// Files are written by one rank. A throw there alone would leave the others
/// waiting in the next collective call for ever.
///
/// Collective over `comm`.
/// @throws std::runtime_error on all ranks, with the first rank's words
void on_root(MPI_Comm comm, const std::function<void()>& work);
} // namespace mmale::output
