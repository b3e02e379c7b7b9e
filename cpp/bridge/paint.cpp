#include "paint.h"
#include "remap/domain/partial_volumes.h"
#include <cstdlib>
#include <cstdio>
namespace mmale::bridge
{
// temporary: MMALE_RECT="x0 y0 x1 y1": material 1 outside (void), 0 inside
::remap::Materials paint(const scene::Scene& scene, const mesh::Domain& domain)
{
  int n = (int)scene.material.size();
  ::remap::Materials m(domain.num_cells(), n, n - 1);
  double a, b, c, d;
  std::sscanf(std::getenv("MMALE_RECT"), "%lf %lf %lf %lf", &a, &b, &c, &d);
  auto D = ::remap::Domain::rectangle({a, b}, {c, d});
  std::vector<std::int32_t> cells;
  for (auto& t : domain.cells) cells.insert(cells.end(), t.begin(), t.end());
  auto pv = ::remap::partial_volumes<::remap::Geometry::plane>(D, cells, domain.initial_x);
  m.drop_rows();
  for (int k = 0; k < domain.num_cells(); ++k)
  {
    auto& t = domain.cells[k];
    auto X = [&](int i, int d) { return domain.initial_x[2 * t[i] + d]; };
    double A = 0.5 * ((X(1,0)-X(0,0))*(X(2,1)-X(0,1)) - (X(2,0)-X(0,0))*(X(1,1)-X(0,1)));
    double f = pv.parts[k].v / A;
    if (f > 1 - 1e-12) m.set_pure(k, 0);
    else if (f < 1e-12) m.set_pure(k, n - 1);
    else {
      ::remap::Point cen = pv.parts[k].centroid();
      ::remap::Point mid{(X(0,0)+X(1,0)+X(2,0))/3,(X(0,1)+X(1,1)+X(2,1))/3};
      ::remap::Point o = (1/(1-f))*(mid - f*cen);
      ::remap::Part P[2] = {{0, f, cen}, {n - 1, 1 - f, o}};
      m.add_row(k, P);
    }
  }
  return m;
}
}
