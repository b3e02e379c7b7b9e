// SPDX-License-Identifier: LGPL-3.0-or-later
#include "environment.h"
#include <csignal>
#include <dolfinx/common/log.h>
#include <petscsys.h>
#include <spdlog/spdlog.h>
#include <stdexcept>

namespace mmale
{
Environment::Environment(std::string program, std::vector<std::string> options)
    : _words(std::move(options))
{
  // A file that may not grow is an error of the write, not the end of us.
  std::signal(SIGXFSZ, SIG_IGN);
  _words.insert(_words.begin(), std::move(program));
  for (std::string& word : _words)
    _arguments.push_back(word.data());
  _arguments.push_back(nullptr);

  int argc = static_cast<int>(_words.size());
  char** argv = _arguments.data();
  if (PetscInitialize(&argc, &argv, nullptr, nullptr) != 0)
    throw std::runtime_error("PETSc could not be initialised");
  // Warnings and worse; SPDLOG_LEVEL in the environment asks for more.
  dolfinx::init_logging(argc, argv);
}

Environment::~Environment()
{
  // A failure to finalise cannot be mended any more.
  static_cast<void>(PetscFinalize());
}
} // namespace mmale

#if defined(__SANITIZE_ADDRESS__)
/// MPI and PETSc keep memory until the process ends; not ours to report.
extern "C" const char* __asan_default_options()
{
  return "detect_leaks=0";
}
#endif
