// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "output/checks.h"
#include "scene/scene.h"
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

/// PNG pictures of a run, drawn without being asked.
///
/// In: what the scene wants drawn and what the run is checked against. Out:
/// `pictures.json` in the folder of the run, and the pictures that `draw.py`
/// makes from it, from curves.csv and from the field files.
namespace mmale::output
{
using scene::ReferenceLine;

/// How curves share a picture.
enum class Layout
{
  together,   ///< in one chart
  panels,     ///< each with its own, for they differ in unit
  diagnostics ///< small panels, without those that are NaN or 0 throughout
};

/// A known point of curve `y` where curve `x` has a value.
struct KnownPoint
{
  std::string x = {};
  double at = 0;
  std::string y = {};
  double value = 0;
};

/// Those that references tell: near a value, at a place.
std::vector<KnownPoint> known_points(std::span<const Reference> references);

/// Curves over one abscissa in one picture.
struct Chart
{
  std::string name = {};           ///< of the file, without ".png"
  std::string x = {};              ///< column of curves.csv
  std::vector<std::string> y = {}; ///< columns of curves.csv
  std::vector<ReferenceLine> references = {};
  std::vector<KnownPoint> points = {}; ///< drawn if they are of its columns
  Layout layout = Layout::together;
  std::string title = {};                 ///< default that of the run
  std::string x_label = {}, y_label = {}; ///< default the names
};

/// One curve over another.
struct Panel
{
  std::string x = {}, y = {}; ///< columns of curves.csv
  bool log_x = false;
};

/// Panels with abscissas of their own in one picture.
struct Sheet
{
  std::string name = {}; ///< of the file, without ".png"
  std::vector<Panel> panels = {};
  std::vector<KnownPoint> points = {}; ///< drawn in panels of their columns
  std::string data = {}; ///< measured points in the run's folder, or ""
};

/// What a field is, for its colour bar.
struct FieldInfo
{
  std::string unit = {}; ///< empty for a number without unit
};

/// What draw.py is told.
struct Pictures
{
  std::string title = {};
  std::vector<Chart> charts = {};
  std::map<std::string, scene::Picture> fields = {}; ///< by name of the file
  std::map<std::string, FieldInfo> info = {};        ///< by name of the field
  std::string field_file = "fields.pvd"; ///< in the folder of the run
  std::string arrows = "velocity";       ///< nodal field drawn as arrows
  bool axisymmetric = false;
  /// Drawn beside what the mesh cuts out of them, from NAME.txt and NAME.vtp.
  std::vector<std::string> domains = {};
  std::vector<Sheet> sheets = {};
};

/// Charts of references: each curve with a reference at a place over that
/// place's curve, the reference as a line.
///
/// @param[in] curves  those that the scene names; varieties of a charted curve
///                    (p_sy_eff of p_sy) are drawn beside it
std::vector<Chart> charts(std::span<const std::string> curves,
                          std::span<const Reference> references);

/// Pictures of a scene: its charts, or those of the references if it has none;
/// `curves`, its curves that no chart shows; `diagnostics`, all other columns.
///
/// @param[in] columns of curves.csv
Pictures pictures(const scene::Scene& scene,
                  std::span<const std::string> columns,
                  std::span<const Reference> references,
                  const std::map<std::string, FieldInfo>& info);

/// Text of pictures.json.
std::string to_json(const Pictures& pictures);

/// Write pictures.json and draw; on one rank only.
///
/// @param[in] folder of the run
/// @return empty, or in words why there are no pictures (no Python, no
/// matplotlib, unwritable folder); the run itself is not at fault
[[nodiscard]] std::string draw(const std::filesystem::path& folder,
                               const Pictures& pictures);

/// Draw each chart and each field picture of a sweep with all its runs.
///
/// @param[in] folder   of the sweep; the pictures go there
/// @param[in] members  folders of the runs
/// @return as for draw()
[[nodiscard]] std::string
draw_sweep(const std::filesystem::path& folder,
           std::span<const std::filesystem::path> members);

/// Where draw.py is: MMALE_DRAW if set, else as installed or built.
std::filesystem::path draw_program();
} // namespace mmale::output
