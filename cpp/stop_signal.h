// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <mpi.h>

namespace mmale
{
/// While it lives, INT, TERM and USR1 ask the run to end after its step, with
/// its state saved. (The launcher sends USR1: it passes mpirun unharmed.) A
/// second one ends the program at once.
class StopSignal
{
public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  /// Has any rank been asked? Collective.
  bool requested(MPI_Comm comm) const;
};
} // namespace mmale
