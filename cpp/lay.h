// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "run.h"

namespace mmale
{
/// Lay the domains of a scene without stages over its mesh and write what came
/// out: METHOD.md, step 0. For each domain: its volume fractions and centroids
/// as fields, its parts of the cells as polygons (NAME.vtp), its outline
/// (NAME.txt), columns of curves.csv, an entry of the ledger, and a picture.
///
/// Collective over `comm`. The scene has no complaints left.
Result lay(MPI_Comm comm, const scene::Scene& scene, const RunOptions& options);
} // namespace mmale
