// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <map>
#include <string>

namespace mmale::output
{
/// Versions of DOLFINx, PETSc and MPI that run, beside those of `Summary`.
std::map<std::string, std::string> versions();
} // namespace mmale::output
