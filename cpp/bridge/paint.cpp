#include "paint.h"
#include "remap/domain/paint.h"
#include <cstdlib>
#include <sstream>
namespace mmale::bridge
{
// temporary: MMALE_RECT="k x0 y0 x1 y1 k x0 ..." over the last material
::remap::Materials paint(const scene::Scene& scene, const mesh::Domain& domain)
{
  int n = (int)scene.material.size();
  std::vector<::remap::Coat> coats;
  coats.push_back({{}, n - 1, true});
  std::istringstream in(std::getenv("MMALE_RECT"));
  double k, a, b, c, d;
  while (in >> k >> a >> b >> c >> d)
    coats.push_back({::remap::Domain::rectangle({a, b}, {c, d}), (int)k, false});
  std::vector<std::int32_t> cells;
  for (auto& t : domain.cells) cells.insert(cells.end(), t.begin(), t.end());
  return ::remap::paint<::remap::Geometry::plane>(coats, cells, domain.initial_x, n).materials;
}
}
