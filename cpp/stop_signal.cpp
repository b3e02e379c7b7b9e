// SPDX-License-Identifier: LGPL-3.0-or-later
#include "stop_signal.h"

#include <csignal>

namespace mmale
{
namespace
{
volatile std::sig_atomic_t asked = 0;
constexpr int signals[] = {SIGINT, SIGTERM, SIGUSR1};

extern "C" void ask(int signal)
{
  asked = 1;
  std::signal(signal, SIG_DFL);
}
} // namespace

StopSignal::StopSignal()
{
  asked = 0;
  for (int s : signals)
    std::signal(s, ask);
}

StopSignal::~StopSignal()
{
  for (int s : signals)
    std::signal(s, SIG_DFL);
}

bool StopSignal::requested(MPI_Comm comm) const
{
  int any = asked;
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, comm);
  return any != 0;
}
} // namespace mmale
