// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "scene/choices.h"
#include "scene/range.h"
#include "scene/scene.h"
#include <algorithm>
#include <concepts>
#include <initializer_list>
#include <string>
#include <vector>

/// The keys of a scene, each named once.
///
/// `keys(visit, table)` calls the visitor once for every key of a table, in
/// the order in which a scene reads well. Reader, range checks, description
/// and key reference are visitors, so a new key is one line here.
namespace mmale::scene
{
/// What is known of a key besides its type.
struct Key
{
  std::string name;
  std::string unit;     ///< "m"; "-" without dimension; "" when not a number
  std::string sentence; ///< what it is, one sentence
  Range range = {};     ///< of every number in it
  std::vector<std::string> choices = {}; ///< of a text; empty: anything
  bool needed = false; ///< a text or name that must be written
};

/// Is T a table with `keys`? What is no part of a scene says so beside its own
/// `keys`.
template <class T>
inline constexpr bool is_table =
    OneOf<T, Mesh, Grading, Boundary, Material, Water, Wall, Condition,
          Dynamics, Stage, Solver, Remap, Tracer, Domain, Region, Initial,
          AtDepth, Motion, Curve, Line, ReferenceLine, Chart, Picture, Output,
          Scene>;

template <class T>
concept Table = is_table<T>;

template <class V>
void keys(V& v, Grading& g)
{
  v({"towards", "m", "Point towards which the cells shrink."}, g.towards);
  v({"size", "m", "Edge of the cells at that point.", above(0)}, g.size);
  v({"growth", "-", "Ratio of neighbouring edges.", {1, 2, true, false}},
    g.growth);
  v({"radius", "m", "Half-breadth of a uniform fine zone around the point.",
     at_least(0)},
    g.radius);
}

template <class V>
void keys(V& v, Mesh& m)
{
  v({"shape", "", "Shape of the domain.", {}, mesh_shapes, true}, m.shape);
  v.only_with(
      "shape", m.shape, mesh_shapes, {0},
      [&]
      {
        v({"width", "m", "Width of the rectangle.", above(0)}, m.width);
        v({"height", "m", "Height of the rectangle.", above(0)}, m.height);
        v({"origin", "m", "Lower left corner of the rectangle."}, m.origin);
      });
  v.only_with("shape", m.shape, mesh_shapes, {1},
              [&]
              {
                v({"corners", "m",
                   "Corners, counter-clockwise from the lower left one."},
                  m.corners);
              });
  v.only_with("shape", m.shape, mesh_shapes, {2},
              [&]
              {
                v({"file",
                   "",
                   "Gmsh file, .geo or .msh, beside the scene.",
                   {},
                   {},
                   true},
                  m.file);
              });
  v.only_with(
      "shape", m.shape, mesh_shapes, {0, 1},
      [&]
      {
        v({"size", "m",
           "Edge of the cells away from the grading, instead of cells.",
           at_least(0)},
          m.size);
        v({"cells", "-", "Number of edges along x and y, instead of size.",
           at_least(0)},
          m.cells);
        v({"diagonal", "", "How a quadrilateral is cut into two triangles."},
          m.diagonal);
        v({"grading", "", "Smaller cells around a point."}, m.grading);
        v({"distortion",
           "-",
           "Inner nodes are moved at random by up to this share of an edge.",
           {0, 0.4, false, true}},
          m.distortion);
      });
  v({"refine", "-",
     "Divides size, the grading's size and a .geo's sizes, multiplies cells.",
     above(0)},
    m.refine);
}

template <class V>
void keys(V& v, Boundary& b)
{
  v({"side", "", "Side that it is a part of.", {}, sides, true}, b.side);
  v({"from", "m", "Its start along the side; default the side's.", unbounded()},
    b.from);
  v({"to", "m", "Its end along the side; default the side's.", unbounded()},
    b.to);
  v({"inflow", "",
     "Material that comes in over it with the velocity that is prescribed."},
    b.inflow);
}

template <class V>
void keys(V& v, Material& m)
{
  v({"law", "", "Name of the material law."}, m.law);
  v.rest("What the law takes, by its names.", m);
}

template <class V>
void keys(V& v, Tracer& t)
{
  v({"shape", "", "Shape of the marked region.", {}, {"circle"}, true},
    t.shape);
  v({"centre", "m", "Centre of the circle."}, t.centre);
  v({"radius", "m", "Radius of the circle.", above(0)}, t.radius);
  v({"inside", "-", "Value inside the region."}, t.inside);
  v({"outside", "-", "Value outside, also of what flows in."}, t.outside);
  v({"cut_cells",
     "",
     "Cells that the circle cuts: a mean by area, or what their centre has.",
     {},
     {"share", "centre"}},
    t.cut_cells);
}

template <class V>
void keys(V& v, Domain& d)
{
  v({"file",
     "",
     "SVG with filled paths (y is turned up), or text with a point x y a line.",
     {},
     {},
     true},
    d.file);
  v({"height", "m", "Height of the box around it; 0 means by scale.",
     at_least(0)},
    d.height);
  v({"scale", "m", "Length of the file's unit.", above(0)}, d.scale);
  v({"at", "m", "Lower left corner of its box; default as in the file."}, d.at);
  v({"tolerance", "m",
     "How far chords may be from an SVG's curves; 0: 1e-4 of the height.",
     at_least(0)},
    d.tolerance);
}

template <class V>
void keys(V& v, AtDepth& a)
{
  v({"depth", "m", "Depth below the ground surface."}, a.depth);
  v({"value", "-", "Value there.", above(0)}, a.value);
}

template <class V>
void keys(V& v, Initial& i)
{
  v({"velocity", "m/s", "Of the whole body; for a first stage with dynamics."},
    i.velocity);
  v({"pressure", "Pa", "Stress everywhere, the same in all directions."},
    i.pressure);
  v({"K0", "-",
     "Ground at rest under its weight: horizontal over vertical stress.",
     above(0)},
    i.K0);
  v({"surface", "m", "Where the ground surface lies; default the body's top."},
    i.surface);
  v({"surcharge", "Pa", "Vertical stress at the ground surface.", at_least(0)},
    i.surcharge);
  v({"water_table", "m",
     "Where the pore pressure is 0; default the surface. Pores are full "
     "above."},
    i.water_table);
  v({"void_ratio", "",
     "Void ratio by depth, instead of the law's; linear in between."},
    i.void_ratio);
}

template <class V>
void keys(V& v, Motion& m)
{
  v({"centre", "m", "Centre of the rotation."}, m.centre);
  v({"revolutions", "-", "Turns over the stage; clockwise is negative."},
    m.revolutions);
}

inline const std::vector<std::string> grips = {"smooth", "rough"};

template <class V>
void keys(V& v, Wall& w)
{
  v({"x", "m", "Where an upright wall stands."}, w.x);
  v({"y", "m", "Or where a level wall lies."}, w.y);
  v({"grip",
     "",
     "Smooth: slides and lifts off; rough: holds what it touches.",
     {},
     grips},
    w.grip);
  v({"velocity_x", "m/s", "Velocity of a rough level wall."}, w.velocity_x);
  v({"velocity_y", "m/s", "Velocity of a rough upright wall."}, w.velocity_y);
}

template <class V>
void keys(V& v, Condition& c)
{
  v({"fixed", "", "No displacement at all."}, c.fixed);
  v({"roller", "", "No displacement normal to the side."}, c.roller);
  v({"displacement_x", "m", "Displacement along x since the stage began."},
    c.displacement_x);
  v({"displacement_y", "m", "Displacement along y since the stage began."},
    c.displacement_y);
  v({"velocity_x", "m/s", "Rate of the displacement along x."}, c.velocity_x);
  v({"velocity_y", "m/s", "Rate of the displacement along y."}, c.velocity_y);
  v({"traction_x", "Pa", "Force on the body along x per area."}, c.traction_x);
  v({"traction_y", "Pa", "Force on the body along y per area."}, c.traction_y);
  v({"pressure", "Pa", "Pressure on the body, stays normal to the surface."},
    c.pressure);
  v({"wall", "", "Rigid wall that it may touch and cannot pass."}, c.wall);
  v({"absorbing", "", "Dashpots let waves out; of a stage with dynamics."},
    c.absorbing);
  v({"drained", "", "Pore pressure 0; otherwise no water passes."}, c.drained);
  v({"pore_pressure", "Pa", "Prescribed pore pressure."}, c.pore_pressure);
  v({"seepage_face", "", "Drained where water flows out, else closed."},
    c.seepage_face);
}

template <class V>
void keys(V& v, Dynamics& d)
{
  v({"beta", "-", "Newmark's parameter; 0 is explicit.", {0, 1, false, false}},
    d.beta);
  v({"gamma",
     "-",
     "Newmark's parameter; above 1/2 damps, below lets the motion grow.",
     {0, 1, true, false}},
    d.gamma);
  v({"alpha",
     "-",
     "HHT's parameter instead of the two; below 0 it damps the highest modes.",
     {-1. / 3, 0, false, false}},
    d.alpha);
  v({"damping_mass", "1/s", "Rayleigh damping in proportion to mass.",
     at_least(0)},
    d.damping_mass);
  v({"damping_stiffness", "s",
     "Rayleigh damping in proportion to elastic stiffness.", at_least(0)},
    d.damping_stiffness);
}

template <class V>
void keys(V& v, Stage& s)
{
  v({"name", "", "Name, also used on the command line.", {}, {}, true}, s.name);
  v({"duration", "s", "Length of the stage.", above(0)}, s.duration);
  v({"step", "s", "First time step.", above(0)}, s.step);
  v({"step_min", "s", "Steps are not halved below; 0 means step / 1024.",
     at_least(0)},
    s.step_min);
  v({"step_max", "s", "Steps do not grow beyond; 0 means step.", at_least(0)},
    s.step_max);
  v({"gravity", "m/s^2", "Acceleration along x and y."}, s.gravity);
  v({"dynamics", "", "Inertia; without this table the stage is quasi-static."},
    s.dynamics);
  v({"boundary", "", "What holds on a boundary, by its name."}, s.boundary);
}

template <class V>
void keys(V& v, Solver& s)
{
  v({"element", "", "Element of the Lagrangian step."}, s.element);
  v({"layout", "", "Stress states: one a cell, or one a point of it."},
    s.layout);
  v({"points", "-", "Points of a cell in layout quadrature, 3 or 6."},
    s.points);
  v({"tangent", "", "Material tangent in Newton's matrix."}, s.tangent);
  v({"geometric_stiffness", "",
     "Geometric stiffness in the matrix; off needs more iterations."},
    s.geometric_stiffness);
  v({"tolerance", "-",
     "Newton stops at this residual, relative to the cells' forces.",
     between(0, 1)},
    s.tolerance);
  v({"max_iterations", "-", "A step with more Newton iterations is halved.",
     at_least(1)},
    s.max_iterations);
  v({"factorisation", "",
     "Factors of Newton's matrix: lu, or ldlt of its symmetric part."},
    s.factorisation);
  v({"lag_jacobian", "-",
     "The matrix is made and factorised every n-th iteration; 0: as needed.",
     at_least(0)},
    s.lag_jacobian);
  v({"line_search", "", "Line search in Newton's method."}, s.line_search);
  v({"closure", "",
     "What materials that share a cell have in common besides velocity."},
    s.closure);
  v({"void_rule", "",
     "Void in a cell: a free surface, a gap that closes before load passes, or "
     "a "
     "gap where it lies between two bodies alone."},
    s.void_rule);
  v({"spray_below",
     "-",
     "Cells with less than this of bodies beside void bear nothing.",
     {0, 1, false, true}},
    s.spray_below);
  v({"ersatz_stiffness", "-",
     "Stiffness that holds nodes next to the void, over the body's there.",
     at_least(0)},
    s.ersatz_stiffness);
  v({"plastic_bubble", "",
     "The bubble softens as the cell yields; off gives a noisier pressure."},
    s.plastic_bubble);
  v({"bubble_spring",
     "-",
     "Share of the elastic stiffness that holds the bubble, layout quadrature.",
     {0, 1, false, false}},
    s.bubble_spring);
  v({"petsc", "", "More PETSc options, each with the prefix lagrangian_."},
    s.petsc);
}

template <class V>
void keys(V& v, Remap& r)
{
  v({"mode", "", "Where nodes go after a Lagrangian step.", {}, {}, true},
    r.mode);
  v({"every", "-", "Steps between remaps; 0 means only on quality.",
     at_least(0)},
    r.every);
  v({"quality_below",
     "-",
     "A radius ratio below it asks for a remap; 0 means never.",
     {0, 1, false, true}},
    r.quality_below);
  v({"smoother", "", "Name of the smoother."}, r.smoother);
  v({"target",
     "",
     "Shape that the smoother aims at.",
     {},
     {"initial", "equilateral"}},
    r.target);
  v({"sweeps", "-", "Sweeps of the smoother.", at_least(1)}, r.sweeps);
  v({"transport", "", "Name of the transport scheme."}, r.transport);
  v({"interfaces", "", "How interfaces between materials are found."},
    r.interfaces);
  v({"max_loss", "-", "Share of a cell that may leave in one sub-cycle.",
     between(0, 1)},
    r.max_loss);
  v({"max_turnover", "-",
     "Share of a cell that may leave in one remap; where more would, all nodes "
     "go only part of their way. 0: no limit.",
     at_least(0)},
    r.max_turnover);
  v({"surface", "", "Boundaries that are free surfaces."}, r.surface);
  v({"open", "", "Boundaries through which fields pass."}, r.open);
}

template <class V>
void keys(V& v, Curve& c)
{
  v({"quantity", "", "What is recorded at every step.", {}, quantities, true},
    c.quantity);
  v({"boundary", "", "Named boundary that it belongs to."}, c.boundary);
  v({"point", "m", "Material point that it belongs to, as at the start."},
    c.point);
  v({"tracer", "", "Tracer that it belongs to."}, c.tracer);
  v({"material", "", "Material of covered_length."}, c.material);
  v({"divide_by", "-", "The quantity is divided by it, in its own unit."},
    c.divide_by);
  v({"breadth",
     "",
     "Breadth of the boundary that divides the quantity too.",
     {},
     {"nominal", "effective"}},
    c.breadth);
}

template <class V>
void keys(V& v, Line& l)
{
  v({"from", "m", "Start of the line."}, l.from);
  v({"to", "m", "End of the line."}, l.to);
  v({"points", "-", "Number of samples on it.", at_least(2)}, l.points);
}

template <class V>
void keys(V& v, ReferenceLine& r)
{
  v({"value", "-", "Where the line lies, in the unit of the curves."}, r.value);
  v({"label", "", "What it is."}, r.label);
}

template <class V>
void keys(V& v, Chart& c)
{
  v({"x", "", "Abscissa: time, step or a curve."}, c.x);
  v({"y", "", "Curves that it shows."}, c.y);
  v({"references", "", "Values that the curves are held against."},
    c.references);
  v({"title", "", "Title; default the scene's."}, c.title);
  v({"x_label", "", "What stands at the abscissa; default its name."},
    c.x_label);
  v({"y_label", "", "What stands at the ordinate; default the curve's name."},
    c.y_label);
}

template <class V>
void keys(V& v, Picture& p)
{
  v({"field", "", "Field that it shows; without one, the mesh alone."},
    p.field);
  v({"mesh", "", "Draw the mesh."}, p.mesh);
  v({"arrows", "", "Draw the velocity as arrows."}, p.arrows);
  v({"surface", "", "Draw the field as height over the plane."}, p.surface);
  v({"start", "", "Beside it, draw the same at the start."}, p.start);
  v({"at",
     "s",
     "Time of the run that it shows; default the end.",
     {0, infinity, false, false}},
    p.at);
}

template <class V>
void keys(V& v, Output& o)
{
  v({"fields_every", "s",
     "Time between outputs of fields; 0 means start, end and pictures.",
     at_least(0)},
    o.fields_every);
  v({"checkpoint_every", "s",
     "Wall time between checkpoints; 0 means only when the run ends.",
     at_least(0)},
    o.checkpoint_every);
  v({"curve", "", "Columns of curves.csv, by name."}, o.curve);
  v({"line", "", "Values along straight lines, by name."}, o.line);
  v({"chart", "", "Curves in one picture, by name."}, o.chart);
  v({"picture", "", "Pictures, by name."}, o.picture);
}

template <class V>
void keys(V& v, Scene& s)
{
  v({"title", "", "One line for people."}, s.title);
  v({"symmetry", "", "Plane strain, or the axis at x = 0."}, s.symmetry);
  v({"mesh", "", "Domain and its triangles."}, s.mesh);
  v({"boundary", "", "Named parts of sides."}, s.boundary);
  v({"material", "", "Materials, by name."}, s.material);
  v({"region", "",
     "Parts of the body by material, painted in this order: a later one covers "
     "an earlier."},
    s.region);
  v({"water", "", "Water in the pores; without this table all is dry."},
    s.water);
  v({"tracer", "", "Passive scalars carried by the remap, by name."}, s.tracer);
  v({"domain", "", "Polygons laid over the mesh, without stages, by name."},
    s.domain);
  v({"motion", "", "A prescribed rigid rotation instead of mechanics."},
    s.motion);
  v({"initial", "", "The body at the start."}, s.initial);
  v({"stage", "", "Stages of the run, in order."}, s.stage);
  v({"solver", "", "Knobs of the Lagrangian step."}, s.solver);
  v({"remap", "", "Remap between Lagrangian steps."}, s.remap);
  v({"output", "", "What is written besides the summary."}, s.output);
}
} // namespace mmale::scene

#include "scene/schema_region.h"
#include "scene/schema_water.h"
