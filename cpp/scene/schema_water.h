// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

/// The keys of a scene's water; a part of schema.h, which includes it.
namespace mmale::scene
{
inline const std::vector<std::string> drainages = {"undrained", "seepage"};
inline const std::vector<std::string> storages = {"lumped", "consistent"};

template <class V>
void keys(V& v, Water& w)
{
  v({"drainage",
     "",
     "Undrained: no flow; seepage: pore pressure is an unknown of the nodes.",
     {},
     drainages,
     true},
    w.drainage);
  v({"bulk_modulus", "Pa", "Bulk modulus of the water.", above(0)},
    w.bulk_modulus);
  v({"grain_bulk_modulus", "Pa", "Bulk modulus of the grains.", above(0)},
    w.grain_bulk_modulus);
  v({"density", "kg/m^3", "Density of the water.", at_least(0)}, w.density);
  v({"cavitation_pressure",
     "Pa",
     "Below it the water cavitates; counts from the atmosphere's.",
     {-infinity, 0, true, false}},
    w.cavitation_pressure);
  v({"porosity",
     "-",
     "Porosity, for laws without a void ratio.",
     {0, 1, false, true}},
    w.porosity);
  v({"permeability", "m/s",
     "Hydraulic conductivity, at the unit weight density * 9.81 m/s^2.",
     at_least(0)},
    w.permeability);
  v({"storage",
     "",
     "Storage of the nodes; consistent oscillates in small steps.",
     {},
     storages},
    w.storage);
  v({"time_weight",
     "-",
     "Weight of a step's end in the flow; 1 damps, 0.5 is of order 2.",
     {0.5, 1, false, false}},
    w.time_weight);
  v({"frequency", "1/s",
     "Frequency of the load for the report; 0: of the shortest stage.",
     at_least(0)},
    w.frequency);
  v({"drainage_length", "m",
     "Way of the water for the report; 0: the domain's breadth or height.",
     at_least(0)},
    w.drainage_length);
}
} // namespace mmale::scene
