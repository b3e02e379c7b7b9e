// SPDX-License-Identifier: LGPL-3.0-or-later
#include "output/versions.h"

#include "output/summary.h"
#include <array>
#include <dolfinx/common/defines.h>
#include <mpi.h>
#include <petscsys.h>

namespace mmale::output
{
std::map<std::string, std::string> versions()
{
  std::map<std::string, std::string> out = Summary::library_versions();
  out["dolfinx"] = dolfinx::version();

  PetscInt major = 0, minor = 0, patch = 0, release = 0;
  PetscGetVersionNumber(&major, &minor, &patch, &release);
  out["petsc"] = std::to_string(major) + "." + std::to_string(minor) + "."
                 + std::to_string(patch);

  std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> text = {};
  int length = 0;
  MPI_Get_library_version(text.data(), &length);
  const std::string mpi(text.data(), static_cast<std::size_t>(length));
  out["mpi"] = mpi.substr(0, mpi.find(','));
  return out;
}
} // namespace mmale::output
