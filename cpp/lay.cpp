// SPDX-License-Identifier: LGPL-3.0-or-later
#include "lay.h"

#include "bridge/domains.h"
#include "mesh/gmsh.h"
#include "output/checks.h"
#include "output/curves.h"
#include "output/fields.h"
#include "output/on_root.h"
#include "output/pictures.h"
#include "output/summary.h"
#include "output/versions.h"
#include <dolfinx/common/MPI.h>
#include <iostream>
#include <numbers>
#include <spdlog/spdlog.h>

namespace mmale
{
namespace
{
using Laid = std::map<std::string, bridge::LaidDomain>;

/// What curves.csv holds of each domain.
std::vector<std::string> column_names(const scene::Scene& scene)
{
  std::vector<std::string> out = {"time"};
  for (const auto& [name, domain] : scene.domain)
    for (const char* what : {".volume", ".outside", ".centroid_x",
                             ".centroid_y", ".mixed", ".full"})
      out.push_back(name + what);
  return out;
}

std::vector<double> row(const Laid& laid)
{
  std::vector<double> out = {0};
  for (const auto& [name, d] : laid)
    out.insert(out.end(),
               {d.in_cells, d.volume - d.in_cells, d.centroid[0], d.centroid[1],
                static_cast<double>(d.mixed), static_cast<double>(d.full)});
  return out;
}

/// The domain's volume is found again in the cells.
output::Ledger ledger(const Laid& laid, bool axisymmetric)
{
  output::Ledger out;
  for (const auto& [name, d] : laid)
    out.push_back({.name = name,
                   .unit = axisymmetric ? "m3" : "m2",
                   .start = d.volume,
                   .end = d.in_cells});
  return out;
}

std::vector<std::string> ledger_names(const scene::Scene& scene)
{
  std::vector<std::string> out;
  for (const auto& [name, domain] : scene.domain)
    out.push_back(name);
  return out;
}

output::References references(const scene::Scene& scene,
                              const RunOptions& options)
{
  output::References out;
  if (not options.reference.empty())
    out = output::read_references(options.reference, column_names(scene),
                                  ledger_names(scene));
  std::string all;
  for (const auto& c : out.complaints)
    all += (all.empty() ? "" : "\n") + c;
  if (not all.empty())
    throw std::runtime_error(all);
  return out;
}

/// Files of each domain, and the fields of the mesh. Collective.
output::Fields write_files(const mesh::Domain& mesh, const Laid& laid,
                           const RunOptions& options)
{
  output::on_root(mesh.comm,
                  [&]
                  {
                    for (const auto& [name, d] : laid)
                    {
                      write(options.results / (name + ".vtp"), d.pieces);
                      output::write_atomically(
                          options.results / (name + ".txt"), d.outline);
                    }
                  });
  output::Fields fields(mesh.mesh, options.results);
  std::vector<output::NamedField> named;
  for (const auto& [name, d] : laid)
  {
    named.push_back({name, output::Location::cell, 1, d.share, "-"});
    named.push_back(
        {name + "_centroid", output::Location::cell, 2, d.centroids, "m"});
  }
  fields.write(0, named);
  return fields;
}

output::Pictures pictures(const scene::Scene& scene, const Laid& laid,
                          const output::Fields& fields)
{
  output::Pictures out = output::pictures(scene, {}, {}, fields.info());
  for (const auto& [name, d] : laid)
    out.domains.push_back(name);
  return out;
}
} // namespace

Result lay(MPI_Comm comm, const scene::Scene& scene, const RunOptions& options)
{
  output::Clock clock;
  const bool root = dolfinx::MPI::rank(comm) == 0;
  const bool axisymmetric = scene.symmetry == scene::Symmetry::axisymmetric;
  const output::References known = references(scene, options);
  const mesh::Domain mesh = mesh::make_domain(
      comm, options.grid ? *options.grid : mesh::obtain_grid(comm, scene),
      scene.boundary);
  Laid laid;
  {
    const auto scope = clock.scope("0 domain");
    for (const auto& [name, domain] : scene.domain)
      laid[name] = bridge::lay(mesh, name, domain, axisymmetric);
  }
  std::optional<output::Fields> fields;
  output::Curves curves(column_names(scene));
  {
    const auto scope = clock.scope("5 output");
    fields.emplace(write_files(mesh, laid, options));
    output::on_root(comm,
                    [&]
                    {
                      curves = output::Curves(options.results / "curves.csv",
                                              column_names(scene));
                    });
    output::on_root(comm, [&] { curves.add(row(laid)); });
    if (not root)
      curves.add(row(laid));
  }
  output::Summary summary;
  summary.title = scene.title;
  summary.outcome = "completed";
  summary.ranks = dolfinx::MPI::size(comm);
  summary.versions = output::versions();
  summary.scene = options.scene_as_understood;
  summary.cells = mesh.cell_map().size_global();
  summary.nodes = mesh.nodes().size_global();
  summary.ledger = ledger(laid, axisymmetric);
  summary.checks = output::evaluate(known.entries, curves, summary.ledger);
  summary.timers = clock.timings(summary.cells,
                                 [comm](std::span<double> v)
                                 {
                                   MPI_Allreduce(MPI_IN_PLACE, v.data(),
                                                 static_cast<int>(v.size()),
                                                 MPI_DOUBLE, MPI_MAX, comm);
                                 });
  summary.wall_seconds = clock.wall();
  output::on_root(comm,
                  [&] { write(options.results / "summary.json", summary); });
  if (root)
  {
    if (not options.quiet)
      std::cout << output::table(summary.timers, summary.wall_seconds)
                << output::table(summary.checks) << std::flush;
    const auto trouble =
        output::draw(options.results, pictures(scene, laid, *fields));
    if (not trouble.empty())
      spdlog::warn("no pictures: {}", trouble);
  }
  Result result;
  result.outcome = summary.outcome;
  result.completed = true;
  result.checks_hold = output::all_hold(summary.checks);
  for (const auto& name : curves.names())
    result.last[name] = curves.column(name).back();
  return result;
}
} // namespace mmale
