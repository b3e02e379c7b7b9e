// SPDX-License-Identifier: LGPL-3.0-or-later
//
// domain_cases DRAWING.svg TOLERANCE: areas of a drawing's parts of the cells
// of several meshes, by several ways, in turn; a row a case as CSV. A drawing
// of 300 x 200 over [0, 3] x [0, 2].

#include "remap/domain/drawing.h"
#include "remap/domain/partial_volumes.h"
#include "remap/tests/fuzz/exact_domain.h"

#include <CGAL/Arr_overlay_2.h>
#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/version_macros.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

using namespace remap;

namespace
{
using exact_domain::exact;
using exact_domain::Kernel;
using exact_domain::Polygon;
using exact_domain::Set;
using Areas = std::vector<double>;

/// Processor time of this process [s].
double seconds()
{
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

struct Mesh
{
  std::vector<std::int32_t> cells;
  std::vector<double> x;

  /// Squares of 2 / n, cut along alternating diagonals, nodes within shaken.
  explicit Mesh(int n)
  {
    const int nx = 3 * n / 2, ny = n;
    unsigned state = 1;
    const auto random = [&state]
    {
      state = 1664525 * state + 1013904223;
      return state / 4294967296.0 - 0.5;
    };
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i)
      {
        const bool inner = i > 0 and i < nx and j > 0 and j < ny;
        const double h = inner ? 1.0 / n : 0;
        x.push_back(2.0 * i / n + 0.5 * h * random());
        x.push_back(2.0 * j / n + 0.5 * h * random());
      }
    const auto add = [this](int a, int b, int c)
    { cells.insert(cells.end(), {a, b, c}); };
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
      {
        const int a = j * (nx + 1) + i, b = a + 1, d = a + nx + 1, c = d + 1;
        if ((i + j) % 2 == 1)
          add(a, b, d), add(b, c, d);
        else
          add(a, b, c), add(a, c, d);
      }
  }
  [[nodiscard]] std::size_t size() const { return cells.size() / 3; }
  [[nodiscard]] Triangle place(std::size_t c) const
  {
    return {point(x, cells[3 * c]), point(x, cells[3 * c + 1]),
            point(x, cells[3 * c + 2])};
  }
};

double area(const Set& set)
{
  std::vector<CGAL::Polygon_with_holes_2<Kernel>> parts;
  set.polygons_with_holes(std::back_inserter(parts));
  Kernel::FT sum = 0;
  for (const auto& part : parts)
  {
    sum += part.outer_boundary().area();
    for (const Polygon& hole : part.holes())
      sum += hole.area();
  }
  return CGAL::to_double(CGAL::exact(sum));
}

/// A cell at a time, those that the outline touches; the others as ours has
/// them, which saves CGAL their time.
Areas by_cells(const Set& domain, const Mesh& mesh, const PartialVolumes& ours)
{
  Areas out;
  for (const Moments& m : ours.parts)
    out.push_back(m.v);
  for (const std::int32_t c : ours.mixed)
  {
    Set part = domain;
    part.intersection(exact(mesh.place(static_cast<std::size_t>(c))));
    out[static_cast<std::size_t>(c)] = area(part);
  }
  return out;
}

/// All of them in one sweep: a plan of the mesh and one of the rings, overlaid.
using Traits = CGAL::Arr_segment_traits_2<Kernel>;
using Plan =
    CGAL::Arrangement_2<Traits, CGAL::Arr_face_extended_dcel<Traits, int>>;

Areas in_one(const Domain& domain, const Mesh& mesh)
{
  std::vector<Traits::Curve_2> edges;
  std::vector<std::array<std::int32_t, 2>> pairs;
  for (std::size_t c = 0; c < mesh.size(); ++c)
    for (std::size_t k = 0; k < 3; ++k)
    {
      const std::int32_t a = mesh.cells[3 * c + k],
                         b = mesh.cells[3 * c + (k + 1) % 3];
      pairs.push_back({std::min(a, b), std::max(a, b)});
    }
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  for (const auto& [a, b] : pairs)
  {
    const Point p = point(mesh.x, a), q = point(mesh.x, b);
    edges.emplace_back(Kernel::Point_2(p.x, p.y), Kernel::Point_2(q.x, q.y));
  }
  Plan cells, drawing, both;
  CGAL::insert_non_intersecting_curves(cells, edges.begin(), edges.end());
  edges.clear();
  for (const Ring& ring : domain.rings())
    for (std::size_t i = 0; i < ring.size(); ++i)
    {
      const Point p = ring[i], q = ring[(i + 1) % ring.size()];
      edges.emplace_back(Kernel::Point_2(p.x, p.y), Kernel::Point_2(q.x, q.y));
    }
  CGAL::insert_non_intersecting_curves(drawing, edges.begin(), edges.end());
  // Faces know their cell by its corners, and whether they are filled by how
  // many rings have to be crossed on the way there.
  std::map<std::array<Kernel::Point_2, 3>, int> number;
  for (std::size_t c = 0; c < mesh.size(); ++c)
  {
    std::array<Kernel::Point_2, 3> t;
    for (std::size_t k = 0; k < 3; ++k)
      t[k] = {mesh.place(c)[k].x, mesh.place(c)[k].y};
    std::ranges::sort(t);
    number[t] = static_cast<int>(c);
  }
  for (auto f = cells.faces_begin(); f != cells.faces_end(); ++f)
  {
    f->set_data(-1);
    if (f->is_unbounded())
      continue;
    const auto h = f->outer_ccb();
    std::array<Kernel::Point_2, 3> t = {h->source()->point(),
                                        h->target()->point(),
                                        h->next()->target()->point()};
    std::ranges::sort(t);
    f->set_data(number.at(t));
  }
  std::vector<Plan::Face_handle> to_do{drawing.unbounded_face()};
  for (auto f = drawing.faces_begin(); f != drawing.faces_end(); ++f)
    f->set_data(-1);
  to_do.back()->set_data(0);
  while (not to_do.empty())
  {
    const auto f = to_do.back();
    to_do.pop_back();
    const auto walk = [&](auto first)
    {
      auto h = first;
      do
        if (const auto g = h->twin()->face(); g->data() < 0)
        {
          g->set_data(1 - f->data());
          to_do.push_back(g);
        }
      while (++h != first);
    };
    for (auto c = f->outer_ccbs_begin(); c != f->outer_ccbs_end(); ++c)
      walk(*c);
    for (auto c = f->inner_ccbs_begin(); c != f->inner_ccbs_end(); ++c)
      walk(*c);
  }
  struct Join
  {
    int operator()(int cell, int filled) const
    {
      return filled == 1 ? cell : -1;
    }
  };
  CGAL::Arr_face_overlay_traits<Plan, Plan, Plan, Join> join;
  CGAL::overlay(cells, drawing, both, join);
  std::vector<Kernel::FT> sums(mesh.size(), 0);
  const auto add = [&sums](auto first, int cell)
  {
    auto h = first;
    do
    {
      const auto &p = h->source()->point(), &q = h->target()->point();
      sums[static_cast<std::size_t>(cell)] += p.x() * q.y() - p.y() * q.x();
    } while (++h != first);
  };
  for (auto f = both.faces_begin(); f != both.faces_end(); ++f)
    if (f->data() >= 0)
    {
      for (auto c = f->outer_ccbs_begin(); c != f->outer_ccbs_end(); ++c)
        add(*c, f->data());
      for (auto c = f->inner_ccbs_begin(); c != f->inner_ccbs_end(); ++c)
        add(*c, f->data());
    }
  Areas out;
  for (const auto& s : sums)
    out.push_back(CGAL::to_double(CGAL::exact(s)) / 2);
  return out;
}

/// The share of points of a lattice in the cell that are in the domain.
Areas sampled(const Domain& domain, const Mesh& mesh, int n)
{
  Areas out;
  for (std::size_t c = 0; c < mesh.size(); ++c)
  {
    const auto [a, b, d] = mesh.place(c);
    int inside = 0;
    // centroids of n² triangles, upright and turned
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j)
        for (int turned = 0; turned < (i + j + 1 < n ? 2 : 1); ++turned)
        {
          const double s = (i + (turned + 1) / 3.0) / n,
                       t = (j + (turned + 1) / 3.0) / n;
          inside += domain.holds(a + s * (b - a) + t * (d - a));
        }
    out.push_back(twice_area(a, b, d) / 2 * inside / (n * n));
  }
  return out;
}

struct Case
{
  std::string name;
  std::function<Areas()> run;
  double time = 0;
  Areas areas = {};
};

void report(int n, const Mesh& mesh, std::size_t mixed, const Case& c,
            const Areas& exact)
{
  double worst = 0, sum = 0, all = 0;
  for (std::size_t i = 0; i < exact.size(); ++i)
  {
    const auto [p, q, r] = mesh.place(i);
    const double off = std::abs(c.areas[i] - exact[i]);
    worst = std::max(worst, off / (twice_area(p, q, r) / 2));
    sum += off;
    all += exact[i];
  }
  std::printf("%d,%zu,%zu,%s,%.6g,%.6g,%.6g,%.6g,%.6g\n", n, mesh.size(), mixed,
              c.name.c_str(), c.time,
              1e6 * c.time / static_cast<double>(mesh.size()),
              1e6 * c.time / static_cast<double>(mixed), worst, sum / all);
  std::fflush(stdout);
}
} // namespace

int main(int argc, char* argv[])
{
  if (argc != 3)
    return 1;
  std::ifstream file(argv[1]);
  std::ostringstream text;
  text << file.rdbuf();
  Drawing drawing = read_svg(text.str(), 100 * std::atof(argv[2]));
  for (Shape& shape : drawing.shapes)
    for (Ring& ring : shape.rings)
      for (Point& p : ring)
        p = 0.01 * p + Point{0, 2};
  const Domain domain(drawing.shapes);
  std::size_t points = 0;
  for (const Ring& ring : domain.rings())
    points += ring.size();
  std::fprintf(stderr, "CGAL %s, outline of %zu points\n", CGAL_VERSION_STR,
               points);
  const Set set = exact(domain);
  std::printf("n,cells,mixed,method,seconds,us_per_cell,us_per_mixed_cell,"
              "worst_share,l1\n");
  for (const int n : {8, 16, 32, 64, 128})
  {
    const Mesh mesh(n);
    const auto ours = [&]
    { return partial_volumes<Geometry::plane>(domain, mesh.cells, mesh.x); };
    const PartialVolumes laid = ours();
    std::vector<Case> cases = {
        {"ours",
         [&]
         {
           Areas out;
           for (const Moments& m : ours().parts)
             out.push_back(m.v);
           return out;
         }},
        {"CGAL overlay", [&] { return in_one(domain, mesh); }},
        {"centre of the cell", [&] { return sampled(domain, mesh, 1); }},
        {"4 x 4 points", [&] { return sampled(domain, mesh, 4); }},
    };
    if (n <= 32)
      cases.push_back(
          {"CGAL cell by cell", [&] { return by_cells(set, mesh, laid); }});
    if (n <= 64)
      cases.push_back(
          {"16 x 16 points", [&] { return sampled(domain, mesh, 16); }});
    // In turn; the least time of three, of what is slow of one.
    for (int round = 0; round < 3; ++round)
      for (Case& c : cases)
      {
        if (round > 0 and c.time > 1)
          continue;
        const double t0 = seconds();
        c.areas = c.run();
        const double t = seconds() - t0;
        c.time = round == 0 ? t : std::min(c.time, t);
      }
    // clock() counts microseconds: what is short runs often.
    double t0 = seconds();
    int times = 0;
    for (; seconds() - t0 < 0.2; ++times)
      cases[0].areas = cases[0].run();
    cases[0].time = (seconds() - t0) / times;
    for (const Case& c : cases)
      report(n, mesh, laid.mixed.size(), c, cases[1].areas);
  }
}
