// SPDX-License-Identifier: LGPL-3.0-or-later
//
// What the study smoothing calls through ctypes: a mesh, boundary nodes fixed,
// smoothed by name, with the processor's seconds of the call alone.

#include "remap/smoothing/smooth.h"

#include <algorithm>
#include <ctime>
#include <memory>

namespace
{
struct Session
{
  std::unique_ptr<remap::Mesh> mesh;
  std::vector<remap::Kind> kinds;
  std::vector<std::uint8_t> flags;
};
Session session;

double seconds()
{
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}
} // namespace

extern "C"
{
  /// Names of all smoothers, one a line.
  const char* smoothing_names()
  {
    static const std::string all = []
    {
      std::string out;
      for (const std::string& name : remap::names<remap::Smoothers>())
        out += name + "\n";
      return out;
    }();
    return all.c_str();
  }

  /// @param[in] x     shape (nodes, 2)
  /// @param[in] cells shape (num_cells, 3)
  void smoothing_load(const double* x, std::size_t nodes,
                      const std::int32_t* cells, std::size_t num_cells)
  {
    session.mesh = std::make_unique<remap::Mesh>(
        remap::MeshInput{.cells = {cells, 3 * num_cells},
                         .x = {x, 2 * nodes},
                         .owned_cells = num_cells,
                         .owned_nodes = nodes});
    session.kinds.assign(nodes, remap::Kind::free);
    session.flags.assign(nodes, 1);
    for (std::int32_t f = 0; f < session.mesh->num_facets(); ++f)
      if (session.mesh->on_boundary(f))
        for (std::int32_t i : session.mesh->facet(f))
          session.kinds[i] = remap::Kind::fixed;
  }

  /// One call of a smoother, equilateral targets.
  /// @param[in,out] x     shape (nodes, 2)
  /// @param[out]    outcome of the call, 0 when ok
  /// @return seconds of the call alone
  double smoothing_run(const char* name, int sweeps, double relaxation,
                       double* x, int* outcome)
  {
    remap::Smoothing smoothing(
        *session.mesh,
        {.smoother = *remap::find<remap::Smoothers>(name),
         .sweeps = sweeps,
         .relaxation = relaxation},
        {});
    const std::span<double> nodes(x, 2 * session.kinds.size());
    const double begin = seconds();
    *outcome = static_cast<int>(
        smoothing.smooth(nodes, session.flags, {.kinds = session.kinds}, {}));
    return seconds() - begin;
  }
}
