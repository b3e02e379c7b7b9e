// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// What the user asked for, as plain data.
///
/// The TOML reader fills these aggregates; a C++ program can build them just
/// as well. SI units throughout. `required` marks a value that has no
/// default: it is NaN, and the checks are written so that NaN fails them.
namespace mmale::scene
{
inline constexpr double required = std::numeric_limits<double>::quiet_NaN();
inline constexpr double infinity = std::numeric_limits<double>::infinity();

using Point = std::array<double, 2>;

enum class Symmetry
{
  plane_strain,
  axisymmetric ///< x is the radius r, y the axis z
};

/// How a quadrilateral of the built-in mesh is cut into two triangles.
enum class Diagonal
{
  right,      ///< from lower left to upper right
  left,       ///< from lower right to upper left
  alternating ///< in turn, as on a chessboard
};

/// Cells grow away from a point: edge `size` within `radius` of it, then each
/// next edge longer by the factor `growth`, up to the mesh's own size.
struct Grading
{
  Point towards = {required, required}; ///< [m]
  double size = required;               ///< edge at the point [m]
  double growth = 1.15; ///< ratio of neighbours, 1 < growth <= 2
  double radius = 0;    ///< uniform fine zone around it [m]
};

/// A rectangle [0, width] x [0, height], a quadrilateral given by corners, or
/// triangles from gmsh.
///
/// Sides of the first two are named left, right, bottom, top; corners run
/// counter-clockwise from (left, bottom). Of a gmsh mesh the physical curves
/// are the boundaries.
struct Mesh
{
  std::string shape;        ///< "rectangle" | "quadrilateral" | "gmsh"
  std::string file;         ///< gmsh only: a .geo or a .msh
  std::string folder;       ///< where a relative `file` starts; no key: the
                            ///< reader puts the scene's own folder
  double width = required;  ///< rectangle only [m]
  double height = required; ///< rectangle only [m]
  Point origin = {0, 0};    ///< rectangle's lower left corner [m]
  std::array<Point, 4> corners = {
      {{required, required},
       {required, required},
       {required, required},
       {required, required}}};       ///< quadrilateral only [m]
  double size = 0;                   ///< edge away from the grading [m]; or
  std::array<int, 2> cells = {0, 0}; ///< edges along x and along y
  Diagonal diagonal = Diagonal::right;
  std::optional<Grading> grading;
  double distortion = 0; ///< inner nodes moved at random by up to this share
                         ///< of the local edge, 0 <= distortion < 0.4
  double refine = 1;     ///< every edge is divided by it; 1 for a .msh

  /// The same mesh with refine = 1 and the sizes or cells that it comes to.
  Mesh refined() const;
};

/// A named part of a side: the facets whose midpoint lies between `from` and
/// `to`, measured along x (bottom, top) or y (left, right).
struct Boundary
{
  std::string side;        ///< left | right | bottom | top
  double from = -infinity; ///< [m]
  double to = infinity;    ///< [m]
  std::string inflow;      ///< material that comes in where remaps leave the
                           ///< boundary behind; none: nothing passes
};

/// A law by name and its numbers, texts and lists as written; the law's own
/// aggregate checks them (`material/library.h`).
struct Material
{
  std::string law;
  std::map<std::string, double> parameters = {};
  std::map<std::string, std::string> texts = {};
  std::map<std::string, std::vector<double>> lists = {};
  std::string folder = {}; ///< where relative files start; no key: the reader
                           ///< puts the scene's own folder
};

/// A value over the time of its stage [s]: constant, piecewise linear, or a
/// sine about a mean, which is then the one value.
struct TimeSeries
{
  std::vector<double> time;  ///< ascending; empty for a constant
  std::vector<double> value; ///< same length, or one number
  double amplitude = 0;      ///< of the sine
  double frequency = 0;      ///< [1/s]
  double phase_deg = 0;      ///< at the start of the stage [degrees]

  /// Value at time t; before the first and after the last time it is held.
  double operator()(double t) const;

  /// Exact integral from 0 to t >= 0: the displacement of a velocity.
  double integral(double t) const;
};

/// A rigid wall, upright or level, that a free surface may come to touch and
/// cannot pass: the flank of a punch, the ground that a slope runs out on.
struct Wall
{
  std::optional<double> x;     ///< where an upright one stands [m]
  std::optional<double> y;     ///< or a level one lies [m]
  std::string grip = "smooth"; ///< "smooth": slides and lifts off; "rough":
                               ///< what has touched it moves with it
  /// Of a rough wall, along it [m/s].
  std::optional<TimeSeries> velocity_x, velocity_y;
};

/// Water in the pores of the material; without this table it is dry.
struct Water
{
  std::string drainage; ///< "undrained": water stays where it is; "seepage": it
                        ///< flows, its pressure at the nodes is an unknown
  double bulk_modulus = 2.2e9;        ///< of the water [Pa]
  double grain_bulk_modulus = 36e9;   ///< of the grains [Pa]
  double density = 1000;              ///< of the water [kg/m3]
  double cavitation_pressure = -99e3; ///< it bears no more suction [Pa]
  double porosity = 0;                ///< 0: from the law's void ratio [-]
  double permeability = 0; ///< hydraulic conductivity: velocity at a hydraulic
                           ///< gradient of 1, unit weight density * 9.81 [m/s]
  std::string storage = "lumped"; ///< "consistent" oscillates in small steps
  double time_weight = 1; ///< of the end of a step in the flow: 1 damps, 1/2 is
                          ///< of order 2 and lets sudden loads swing on
  double frequency = 0;   ///< of the load, for the report; 0: of the
                          ///< shortest stage [1/s]
  double drainage_length = 0; ///< likewise; 0: breadth or height [m]

  bool seepage() const { return drainage == "seepage"; }
  double unit_weight() const { return density * 9.81; } ///< [N/m3]
};

/// What holds on a named boundary during a stage.
///
/// Displacements count from the start of the stage. `velocity_*` is their
/// rate; a boundary has one of the two for a direction, never both.
struct Condition
{
  bool fixed = false;  ///< no displacement at all
  bool roller = false; ///< no displacement normal to the side
  std::optional<TimeSeries> displacement_x, displacement_y; ///< [m]
  std::optional<TimeSeries> velocity_x, velocity_y;         ///< [m/s]
  std::optional<TimeSeries> traction_x, traction_y; ///< force on the body [Pa]
  std::optional<TimeSeries> pressure; ///< follows the surface, inward is + [Pa]
  std::optional<Wall> wall;
  bool absorbing = false; ///< dashpots let waves out; of a dynamic stage
  // of the water, with seepage; else no water passes
  bool drained = false;                    ///< pore pressure 0
  std::optional<TimeSeries> pore_pressure; ///< prescribed [Pa]
  bool seepage_face = false; ///< drained where water flows out, else closed
};

/// Inertia in a stage: Newmark's scheme, or HHT's with alpha < 0.
struct Dynamics
{
  double beta = 0.25; ///< Newmark's; 0: explicit
  double gamma = 0.5; ///< Newmark's; > 1/2 damps, < 1/2 lets the motion grow
  double alpha = 0;   ///< HHT's, -1/3 <= alpha < 0: damps the highest modes;
                      ///< beta and gamma then follow from it
  double damping_mass = 0;      ///< Rayleigh's, in proportion to mass [1/s]
  double damping_stiffness = 0; ///< and to the elastic stiffness [s]

  /// With beta = (1 - alpha)^2 / 4 and gamma = 1/2 - alpha where alpha < 0.
  Dynamics resolved() const
  {
    Dynamics d = *this;
    if (alpha < 0)
    {
      d.beta = 0.25 * (1 - alpha) * (1 - alpha);
      d.gamma = 0.5 - alpha;
    }
    return d;
  }
};

/// A stretch of time with its own boundary conditions, loads and steps.
struct Stage
{
  std::string name;
  double duration = required;                ///< [s]
  double step = required;                    ///< first step [s]
  double step_min = 0;                       ///< floor [s]; 0: step / 1024
  double step_max = 0;                       ///< ceiling [s]; 0: step
  std::map<std::string, Condition> boundary; ///< by boundary name
  std::optional<std::array<TimeSeries, 2>> gravity; ///< [m/s^2]
  std::optional<Dynamics> dynamics; ///< without it the stage is quasi-static
};

enum class Element
{
  mini,           ///< the method's own
  equal_order,    ///< without the bubble: shows the checkerboard
  constant_strain ///< displacement only: locks
};

/// Where a cell keeps its stress.
enum class Layout
{
  mean,      ///< one state a cell, from its mean strain
  quadrature ///< one state a point, whose strain includes the bubble
};

enum class Tangent
{
  consistent, ///< derivative of the update
  continuum,  ///< derivative of the rate equations
  robust      ///< the law's stiffest
};

/// How Newton's matrix is factorised.
enum class Factorisation
{
  automatic, ///< ldlt where the law's tangent is symmetric, lu elsewhere
  lu,        ///< the whole tangent
  ldlt ///< its symmetric part: half the work; what is left out of the tangent
       ///< costs iterations, never accuracy
};

/// What void is to the materials that share a cell with it.
enum class VoidRule
{
  surface,   ///< a free surface, integrated where it lies
  by_bodies, ///< beside one body its free surface, between two a gap
  closing    ///< a gap: nothing bears load before it is closed
};

/// Knobs of the Lagrangian step.
struct Solver
{
  Element element = Element::mini;
  Layout layout = Layout::mean;
  int points = 3; ///< of layout `quadrature`: 3 or 6
  Tangent tangent = Tangent::consistent;
  bool geometric_stiffness = true; ///< off: slower Newton, same answer
  double tolerance = 1e-8; ///< relative to the norm of the cells' own forces
  int max_iterations = 15; ///< a step with more fails and is halved
  Factorisation factorisation = Factorisation::automatic;
  int lag_jacobian = 0; ///< matrix and factor are made every n-th iteration; 0:
                        ///< but where one more with the last one will do
  bool line_search = true;
  // of cells that several materials share
  std::string closure = "equal_pressure"; ///< name in the library's list
  VoidRule void_rule = VoidRule::surface;
  double spray_below =
      0.01; ///< a cell with less than this of bodies bears nothing
  double ersatz_stiffness =
      0.01;                    ///< of void in a cell, over what resists there
  bool plastic_bubble = true;  ///< METHOD.md, form P; off: noisier pressure
  double bubble_spring = 0.05; ///< of layout `quadrature`, METHOD.md; 0: steps
                               ///< fail in plastic flow after remaps
  std::string petsc;           ///< more PETSc options, prefix `lagrangian_`
};

enum class RemapMode
{
  lagrangian, ///< never
  ale,        ///< smoothed mesh
  eulerian    ///< nodes go home
};

/// Remap between Lagrangian steps.
struct Remap
{
  RemapMode mode = RemapMode::lagrangian;
  int every = 0;            ///< steps between remaps; 0: only on quality
  double quality_below = 0; ///< radius ratio that asks for a remap; 0: never
  std::string smoother = "optimise"; ///< name in the remap library's list
  std::string target = "initial"; ///< shape aimed at: "initial" | "equilateral"
  int sweeps = 5;                 ///< of the smoother
  std::string transport = "limited_linear"; ///< name in the library's list
  double max_loss = 0.5;   ///< share of a cell that may leave in a sub-cycle
  double max_turnover = 0; ///< and in a remap, where nodes go only part of
                           ///< their way rather than more; 0: no limit
  std::string interfaces = "moment_of_fluid"; ///< of materials in a cell, name
                                              ///< in the library's list
  std::vector<std::string> surface; ///< boundaries that are free surfaces
  std::vector<std::string> open;    ///< boundaries through which fields pass
};

/// A passive scalar per cell, carried by the remap.
struct Tracer
{
  std::string shape;                   ///< "circle"
  Point centre = {required, required}; ///< [m]
  double radius = required;            ///< [m]
  double inside = 1;
  double outside = 0; ///< also what flows in through open boundaries
  std::string cut_cells = "share"; ///< cells that the circle cuts: mixed by
                                   ///< "share" of area, or as their "centre"
};

/// A region bounded by polygons, laid over the mesh of a scene without stages:
/// partial volumes and centroids of the cells.
struct Domain
{
  std::string file;   ///< an SVG, y turned up, or a text: a point "x y" a line
  std::string folder; ///< where a relative `file` starts; no key: the reader
                      ///< puts the scene's own folder
  double height = 0;  ///< of the box around it [m]; 0: by `scale`
  double scale = 1;   ///< length of the file's unit [m]
  std::optional<Point> at; ///< lower left corner of its box [m]; none: the
                           ///< file's origin stays the origin
  double tolerance = 0;    ///< chords are no farther from an SVG's curves [m];
                           ///< 0: 1e-4 of the box's height
};

/// A part of the body that a material fills. Regions are painted in the order
/// written: a later one covers what lies under it.
struct Region
{
  std::string material;             ///< by its name
  std::string shape;                ///< one of `region_shapes`
  Point low = {required, required}; ///< of the rectangle [m]
  Point high = {required, required};
  std::vector<Point> points;           ///< of the polygon, either way round [m]
  Point centre = {required, required}; ///< of the circle [m]
  double radius = required;            ///< of the circle [m]
  Point point = {required, required};  ///< on the half-plane's line [m]
  Point normal = {required, required}; ///< out of the material, of any length
  Domain drawing;                      ///< of shape "file"
};

/// A number at a depth below the ground surface.
struct AtDepth
{
  double depth = required; ///< [m]
  double value = required;
};

/// The body at the start of the run. Unstressed, or with a pressure, or as
/// ground that lies at rest under its weight.
struct Initial
{
  Point velocity = {0, 0};           ///< of all of it [m/s]
  std::optional<double> pressure;    ///< the same everywhere [Pa]
  std::optional<double> K0;          ///< horizontal over vertical stress [-]
  std::optional<double> surface;     ///< of the ground, y [m]; default the top
  double surcharge = 0;              ///< vertical stress at the surface [Pa]
  std::optional<double> water_table; ///< y where the pore pressure is 0 [m];
                                     ///< default the surface
  std::vector<AtDepth> void_ratio;   ///< linear between depths, constant beyond
};

/// A prescribed rigid rotation instead of a Lagrangian step.
struct Motion
{
  Point centre = {required, required}; ///< [m]
  double revolutions = required;       ///< over the stage; clockwise is < 0
};

/// A column of curves.csv.
///
/// value = quantity / (divide_by * breadth); `breadth` is 1, or the extent of
/// the boundary as first laid ("nominal"), or that plus half the first cell
/// beside it ("effective").
struct Curve
{
  std::string quantity;       ///< of a boundary or point: displacement_x|y,
                              ///< velocity_x|y, pressure; of a boundary:
                              ///< reaction_x|y, largest place x_max, y_max;
                              ///< of a point: stress_xx|yy|zz|xy; with water
                              ///< pore_pressure, effective_stress_..; seepage:
                              ///< discharge of a boundary, outward;
                              ///< of a dynamic body: kinetic_energy,
                              ///< internal_work, external_work, total_energy;
                              ///< tracer_max|min|total; of a boundary and a
                              ///< material covered_length, of the boundary
  std::string boundary;       ///< a named boundary (means over it), or
  std::optional<Point> point; ///< a material point given at the start [m]
  std::string tracer;         ///< for tracer_*
  std::string material;       ///< for covered_length
  double divide_by = 1;
  std::string breadth; ///< "" | "nominal" | "effective"
};

/// Values along a straight line, sampled at every output of fields.
struct Line
{
  Point from = {required, required}, to = {required, required}; ///< [m]
  int points = 100;
};

/// A picture drawn from the fields; drawn at the end of the run.
struct Picture
{
  std::string field; ///< name in the field files, or "" for the mesh alone
  bool mesh = true;
  bool arrows = false;  ///< velocity (displacement increment over step)
  bool surface = false; ///< the field as height over the plane
  bool start = false;   ///< and, beside it, the same at the start
  double at = infinity; ///< drawn at this time of the run [s]; default the end
};

/// A value that curves are held against, drawn as a horizontal line.
struct ReferenceLine
{
  double value = required;
  std::string label; ///< where it comes from
};

/// Curves over one abscissa in one picture; a sweep lays its runs into one.
struct Chart
{
  std::string x = "time";     ///< time, step or a curve
  std::vector<std::string> y; ///< curves
  std::vector<ReferenceLine> references;
  std::string title;            ///< default the scene's
  std::string x_label, y_label; ///< default the names
};

struct Output
{
  double fields_every = 0; ///< [s]; 0: start, end, and the pictures' times
  /// Wall time from checkpoint to checkpoint [s]; 0: only when the run ends.
  /// Doubled: half their cost, twice as much to do again after a crash.
  double checkpoint_every = 60;
  std::map<std::string, Curve> curve;
  std::map<std::string, Line> line;
  std::map<std::string, Chart> chart;
  std::map<std::string, Picture> picture;
};

struct Scene
{
  std::string title;
  Symmetry symmetry = Symmetry::plane_strain;
  Mesh mesh;
  std::map<std::string, Boundary> boundary;
  std::map<std::string, Material> material;
  std::vector<Region> region; ///< none: one material fills the body
  std::optional<Water> water;
  std::map<std::string, Tracer> tracer;
  std::map<std::string, Domain> domain;
  std::optional<Motion> motion;
  Initial initial;
  std::vector<Stage> stage; ///< none: domains are laid, nothing moves
  Solver solver;
  Remap remap;
  Output output;
};
} // namespace mmale::scene
