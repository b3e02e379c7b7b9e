// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/check.h"
#include <array>
#include <optional>

/// The checks that look at several keys together, one function a topic.
///
/// Numbers may still be NaN here (that is another complaint): every check is
/// written so that it then stays silent.
namespace mmale::scene
{
using Complaints = std::vector<Complaint>;

void check_mesh(const Scene& scene, Complaints& out);
void check_boundaries(const Scene& scene, Complaints& out);
void check_materials(const Scene& scene, const Libraries& libraries,
                     Complaints& out);
/// Law, set and values of one material; `key` is its table's.
void check_material(const Material& material, const Libraries& libraries,
                    const std::string& key, Complaints& out);
// The outline is null where nothing is known of it.
/// Regions: their materials, their shapes, and what needs them.
void check_regions(const Scene& scene, const Outline* outline,
                   const RegionReader& read_region, Complaints& out);
void check_stages(const Scene& scene, const Outline* outline, Complaints& out);
/// Pore water: what it needs, and what needs it.
void check_water(const Scene& scene, const Libraries& libraries,
                 Complaints& out);
/// Layout and element of the Lagrangian step.
void check_solver(const Scene& scene, Complaints& out);

void check_remap(const Scene& scene, const Libraries& libraries,
                 const Outline* outline, Complaints& out);
void check_tracers(const Scene& scene, const Outline* outline, Complaints& out);
/// Domains, and what a scene without stages has no use for.
void check_domains(const Scene& scene, const Outline* outline,
                   const DomainReader& read_domain, Complaints& out);
void check_output(const Scene& scene, const Libraries& libraries,
                  const Outline* outline, Complaints& out);

/// The outline, from the scene or by `read_mesh`; nothing if it cannot be
/// had. What the mesh file suffers from is added to `out`.
std::optional<Outline>
outline_of(const Scene& scene, const OutlineReader& read_mesh, Complaints& out);

/// What kind of gmsh file the scene names.
bool is_geo(const Mesh& mesh);
bool is_msh(const Mesh& mesh);

/// Corners of the domain, counter-clockwise from (left, bottom); NaN where
/// the scene does not tell [m].
std::array<Point, 4> corners_of(const Mesh& mesh);

/// False when `x` lies outside the domain by more than round-off; true too
/// when the domain is not known or not convex.
bool may_be_inside(const Mesh& mesh, const Point& x);

/// Ends of a side [m], in the corners' order.
std::array<Point, 2> side_ends(const Mesh& mesh, const std::string& side);

/// Complains of a domain whose box has nothing of the mesh in it.
void check_in_mesh(const std::string& key, const DomainOutline& domain,
                   const Outline& outline, Complaints& out);

/// Complains of a height and a scale that do not go together.
void check_scale(const std::string& key, const Domain& domain, Complaints& out);

/// "(0.5, 1.5)".
std::string words(const Point& x);
} // namespace mmale::scene
