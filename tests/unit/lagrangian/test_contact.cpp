// SPDX-License-Identifier: LGPL-3.0-or-later
// Nodes of a free surface at a rigid wall: they touch, are held, and let go.
#include "lagrangian/contact.h"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>

using namespace mmale;
using namespace mmale::lagrangian;

namespace
{
/// Unit square whose right side may meet a wall at x = 1.2, or its top a level
/// one at y = 1.2.
struct Body
{
  explicit Body(const std::string& grip, bool level = false)
      : normal(level ? 1 : 0)
  {
    stage.duration = stage.step = 1;
    const std::string side = level ? "top" : "right";
    auto& wall = stage.boundary[side].wall.emplace();
    (level ? wall.y : wall.x) = 1.2;
    wall.grip = grip;
    (level ? wall.velocity_x : wall.velocity_y) = scene::TimeSeries{{}, {-0.5}};
    conditions.emplace(domain, stage);
    contact.emplace(domain, *conditions);
    z.assign(3 * domain.num_nodes(), 0);
    force.assign(3 * domain.num_nodes(), 0);
    for (int n : domain.boundary_nodes(domain.boundary(side)))
      nodes.push_back(n);
  }

  void move(double u) { set(z, u); }
  void push(double f) { set(force, f); }
  bool update() { return contact->update(domain.initial_x, z, force, 1e6); }

  /// Prescribed displacement of a node, NaN where it is free.
  double held(int node, int direction) const
  {
    auto holder = std::vector<int>(conditions->holder().begin(),
                                   conditions->holder().end());
    std::vector<double> increment(holder.size(), 0);
    contact->apply(domain.initial_x, holder, increment);
    const int i = 3 * node + direction;
    return holder[i] < 0 ? scene::required : increment[i];
  }

  static mmale::mesh::Grid square()
  {
    scene::Mesh m;
    m.shape = "rectangle";
    m.width = m.height = 1;
    m.cells = {2, 2};
    return mmale::mesh::make_grid(m);
  }

  mmale::mesh::Domain domain =
      mmale::mesh::make_domain(MPI_COMM_WORLD, square(), {});
  scene::Stage stage;
  std::optional<Conditions> conditions;
  std::optional<Contact> contact;
  std::vector<double> z, force;
  std::vector<int> nodes;
  int normal;

private:
  void set(std::vector<double>& v, double x)
  {
    for (int n : nodes)
      v[3 * n + normal] = x;
  }
};
} // namespace

TEST_CASE("a node that passes a wall is brought back to it, not before",
          "[unit][contact]")
{
  Body body("smooth");
  body.contact->begin_step(body.domain.initial_x, 0, 1);
  body.move(0.19);
  CHECK_FALSE(body.update());
  CHECK(std::isnan(body.held(body.nodes[0], 0)));
  body.move(0.3);
  CHECK(body.update());
  CHECK(body.held(body.nodes[0], 0) == Catch::Approx(0.2));
  CHECK(std::isnan(body.held(body.nodes[0], 1))); // slides
}

TEST_CASE("a smooth wall lets go what it would have to pull", "[unit][contact]")
{
  Body body("smooth");
  body.contact->begin_step(body.domain.initial_x, 0, 1);
  body.move(0.3);
  CHECK(body.update());
  body.move(0.2);
  body.push(-1e3); // the wall is on the right: to the left is a push
  CHECK_FALSE(body.update());
  CHECK(body.held(body.nodes[0], 0) == Catch::Approx(0.2));
  body.push(1e3);
  CHECK(body.update());
  CHECK(std::isnan(body.held(body.nodes[0], 0)));
}

TEST_CASE("what has touched a rough wall goes with it", "[unit][contact]")
{
  Body body("rough");
  body.contact->begin_step(body.domain.initial_x, 0, 1);
  body.move(0.3);
  CHECK(body.update());
  body.push(1e3);
  CHECK_FALSE(body.update()); // even when pulled
  CHECK(body.held(body.nodes[0], 0) == Catch::Approx(0.2));
  CHECK(body.held(body.nodes[0], 1) == Catch::Approx(-0.5));
}

TEST_CASE("a level wall is an upright one turned by a right angle",
          "[unit][contact]")
{
  for (const std::string grip : {"smooth", "rough"})
    for (const bool pulled : {false, true})
    {
      INFO(grip << (pulled ? ", pulled" : ", pushed"));
      // the x of one is the y of the other; the square is its own mirror image
      Body upright(grip), level(grip, true);
      for (Body* body : {&upright, &level})
      {
        body->contact->begin_step(body->domain.initial_x, 0, 1);
        body->move(0.3);
        CHECK(body->update());
        body->move(0.2);
        body->push(pulled ? 1e3 : -1e3);
        body->update();
      }
      for (int d = 0; d < 2; ++d)
      {
        const double a = upright.held(upright.nodes[0], d);
        const double b = level.held(level.nodes[0], 1 - d);
        CHECK((a == b or (std::isnan(a) and std::isnan(b))));
      }
      const bool let_go = pulled and grip == "smooth";
      CHECK(std::isnan(level.held(level.nodes[0], 1)) == let_go);
    }
}
