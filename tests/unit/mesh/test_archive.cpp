// SPDX-License-Identifier: LGPL-3.0-or-later
// A checkpoint file gives back what it was given, and is there whole or not.
#include "mesh/domain.h"
#include "mesh/grid.h"
#include "output/archive.h"
#include "output/checkpoint.h"
#include "output/on_root.h"

#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cmath>
#include <dolfinx/common/MPI.h>
#include <fstream>

using namespace mmale;
using namespace mmale::output;
using Catch::Matchers::ContainsSubstring;
namespace fs = std::filesystem;

namespace
{
mesh::Domain small_domain(int nx = 6)
{
  scene::Mesh m;
  m.shape = "rectangle";
  m.width = 2;
  m.height = 1;
  m.cells = {nx, 4};
  return mesh::make_domain(MPI_COMM_WORLD, mesh::make_grid(m), {});
}

/// Numbers that tell which entity and component they belong to.
std::vector<double> tagged(const std::vector<std::int64_t>& id, int width)
{
  std::vector<double> out;
  for (std::int64_t i : id)
    for (int k = 0; k < width; ++k)
      out.push_back(100.0 * static_cast<double>(i) + k);
  return out;
}

State state_of(const mesh::Domain& d)
{
  State s;
  for_each_field(s,
                 [&, width = 1](const std::string&, Entity e,
                                std::vector<double>& values) mutable
                 {
                   values = tagged(e == Entity::node ? d.node_id : d.cell_id,
                                   width % 4 + 1);
                   ++width;
                 });
  s.tracer["dye"] = tagged(d.cell_id, 1);
  return s;
}

void keep(Archive& archive, State& state)
{
  for_each_field(state,
                 [&](const std::string& name, Entity entity, auto& values)
                 { archive("state/" + name, entity, values); });
}
} // namespace

TEST_CASE("archive: a state comes back number by number, ghosts too",
          "[unit][archive]")
{
  const auto d = small_domain();
  const fs::path file = "test_archive_state.h5";
  State before = state_of(d);
  Archive out(d);
  CHECK_FALSE(out.loading());
  keep(out, before);
  out.write(file);
  State after;
  after.tracer["dye"] = {};
  Archive in(d, file);
  CHECK(in.loading());
  keep(in, after);
  int fields = 0;
  for_each_field(after,
                 [&](const std::string& name, Entity e, auto& values)
                 {
                   INFO(name);
                   const auto& id = e == Entity::node ? d.node_id : d.cell_id;
                   const auto width =
                       static_cast<int>(values.size() / id.size());
                   CHECK(width >= 1);
                   CHECK(values == tagged(id, width));
                   ++fields;
                 });
  CHECK(fields >= 8);
  CHECK_FALSE(fs::exists(file.string() + ".part"));
}

TEST_CASE("archive: rows lie in the order of the grid, whoever wrote them",
          "[unit][archive]")
{
  const auto d = small_domain();
  const fs::path file = "test_archive_order.h5";
  std::vector<double> x = tagged(d.node_id, 2), s = tagged(d.cell_id, 4);
  Archive out(d);
  out("a/x", Entity::node, x);
  out("a/s", Entity::cell, s);
  out.write(file);
  const DatasetReader reader(file);
  const auto in_order = [](int rows, int width)
  {
    std::vector<std::int64_t> id(rows);
    for (int i = 0; i < rows; ++i)
      id[i] = i;
    return tagged(id, width);
  };
  CHECK(reader.numbers("a/x") == in_order(7 * 5, 2));
  CHECK(reader.numbers("a/s") == in_order(2 * 6 * 4, 4));
}

TEST_CASE("archive: numbers and texts come back to the last bit",
          "[unit][archive]")
{
  const auto d = small_domain();
  const fs::path file = "test_archive_numbers.h5";
  double x = 0.1 + 0.2, nan = std::nan("");
  std::int64_t large = (std::int64_t{1} << 53) + 1;
  int negative = -7;
  std::string text = "two\nlines, \xC3\xA4", none;
  std::vector<double> table{1, 2, 3, 4, 5, 6}, empty;
  std::array<double, 2> pair{3, 4};
  std::vector<std::array<double, 3>> rows{{1, 2, 3}, {4, 5, 6}};
  const auto all = [&](Archive& a)
  {
    a("x", x);
    a("group/deep/nan", nan);
    a("large", large);
    a("negative", negative);
    a("text", text);
    a("none", none);
    a("table", table, 3);
    a("empty", empty);
    a("pair", pair);
    a("rows", rows);
  };
  Archive out(d);
  all(out);
  out.write(file);
  x = nan = 0;
  large = negative = 0;
  text = "old";
  none = "old";
  table = empty = {9};
  pair = {};
  rows.clear();
  Archive in(d, file);
  all(in);
  CHECK(x == 0.1 + 0.2);
  CHECK(std::isnan(nan));
  CHECK(large == (std::int64_t{1} << 53) + 1);
  CHECK(negative == -7);
  CHECK(text == "two\nlines, \xC3\xA4");
  CHECK(none.empty());
  CHECK(table == std::vector<double>{1, 2, 3, 4, 5, 6});
  CHECK(empty.empty());
  CHECK(pair == std::array<double, 2>{3, 4});
  CHECK(rows == std::vector<std::array<double, 3>>{{1, 2, 3}, {4, 5, 6}});
}

TEST_CASE("archive: what is not there, or of another mesh, is refused",
          "[unit][archive]")
{
  const auto d = small_domain();
  const fs::path file = "test_archive_refused.h5";
  double x = 1;
  std::vector<double> table{1, 2, 3, 4};
  Archive out(d);
  out("x", x);
  out("table", table, 2);
  out.write(file);
  Archive in(d, file);
  CHECK_THROWS_WITH(in("y", x), ContainsSubstring("has no 'y'"));
  std::string text;
  CHECK_THROWS_WITH(in("x", text), ContainsSubstring("has no 'x' (text)"));
  CHECK_THROWS_WITH(in("table", table, 4), ContainsSubstring("2 numbers"));
  CHECK_THROWS_WITH(Archive(small_domain(7), file),
                    ContainsSubstring("another mesh"));
  // as many nodes and cells, at other places
  auto moved = small_domain();
  for (double& coordinate : moved.initial_x)
    coordinate *= 1.0000001;
  CHECK_THROWS_WITH(Archive(moved, file), ContainsSubstring("another mesh"));
}

TEST_CASE("archive: an array that the scene does not have is left out",
          "[unit][archive]")
{
  const auto d = small_domain();
  const fs::path file = "test_archive_absent.h5";
  std::vector<double> none;
  Archive out(d);
  out("none", Entity::cell, none);
  out.write(file);
  CHECK_FALSE(DatasetReader(file).has("none"));
  none = {1, 2};
  Archive in(d, file);
  in("none", Entity::cell, none);
  CHECK(none.empty());
}

TEST_CASE("checkpoint file: what cannot be written is said on all processes",
          "[unit][archive]")
{
  const auto d = small_domain();
  on_root(d.comm,
          [] { std::ofstream("test_archive.blocked") << "a file, no folder"; });
  double x = 1;
  Archive out(d);
  out("x", x);
  CHECK_THROWS_WITH(out.write("test_archive.blocked/checkpoint.h5"),
                    ContainsSubstring("checkpoint.h5: Not a directory"));
}

TEST_CASE("checkpoint file: missing, foreign, cut off and whole are told apart",
          "[unit][archive]")
{
  const auto d = small_domain();
  const fs::path folder = "test_archive_kinds", file = folder / checkpoint_name;
  on_root(d.comm,
          [&]
          {
            fs::remove_all(folder);
            fs::create_directories(folder);
          });
  const bool root = dolfinx::MPI::rank(d.comm) == 0;
  if (root)
    CHECK_FALSE(find_checkpoint(folder).there);
  std::int64_t format = checkpoint_format + 1;
  Archive out(d);
  out("format", format);
  out.write(file);
  if (not root)
    return;
  CHECK(file_kind(file) == FileKind::whole);
  CHECK_THAT(find_checkpoint(folder).trouble, ContainsSubstring("format 2"));
  fs::resize_file(file, fs::file_size(file) / 2);
  CHECK(file_kind(file) == FileKind::damaged);
  CHECK_THAT(find_checkpoint(folder).trouble, ContainsSubstring("damaged"));
  std::ofstream(file) << "t,x\n0,1\n";
  CHECK(file_kind(file) == FileKind::foreign);
  CHECK_THAT(find_checkpoint(folder).trouble,
             ContainsSubstring("is no checkpoint"));
}

TEST_CASE("checkpoints are no more than their share of a run",
          "[unit][archive]")
{
  CHECK(checkpoint_wait(60, 0.1) == 60);
  // 3 s of writing at 2 % of the time
  CHECK(std::abs(checkpoint_wait(60, 3) - 150) < 1e-12);
  // who asks for more gets it
  CHECK(checkpoint_wait(0.5, 3) == 0.5);
}
