// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <mpi.h>
#include <string>
#include <vector>

namespace mmale
{
/// MPI, PETSc and the log, from its making to its end: one object in `main`.
class Environment
{
public:
  /// Initialise; collective over all processes.
  ///
  /// @param program  name of the program, for PETSc's messages
  /// @param options  words for PETSc's options database, as typed
  Environment(std::string program, std::vector<std::string> options);
  ~Environment();
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

private:
  // PETSc keeps pointers into the words until it is finalised.
  std::vector<std::string> _words;
  std::vector<char*> _arguments;
};
} // namespace mmale
