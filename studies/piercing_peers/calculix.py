# SPDX-License-Identifier: LGPL-3.0-or-later
"""The piercing block as a CalculiX deck: a slab one brick thick, plane strain.

Half model as in demos/piercing: width B = 1, height 1.5, punch half-breadth 0.5
at the left of the top; smooth walls, a rough punch, sigma_y = 20 kPa, E = 2600 kPa,
nu = 0.3. Finite strain (NLGEOM), automatic increments.
"""

import re

WIDTH, HEIGHT, HALF_BREADTH = 1.0, 1.5, 0.5
YIELD_STRESS = 20e3
SMALL = 1e-9

# local node order of a 20-node brick in half-edge steps (i, j, k)
CORNERS = [(0, 0), (2, 0), (2, 2), (0, 2)]
MIDDLES = [(1, 0), (2, 1), (1, 2), (0, 1)]


def bricks(n, quadratic):
    """Nodes and elements of a slab of n x 1.5 n bricks; half-edge numbering."""
    nx, ny = n, round(1.5 * n)
    number, nodes, elements = {}, [], []

    def node(i, j, k):
        if (i, j, k) not in number:
            number[i, j, k] = len(nodes) + 1
            h = 0.5 / n
            nodes.append((i * h, j * h, k * h))
        return number[i, j, k]

    for row in range(ny):
        for column in range(nx):

            def at(corner, k):
                return node(2 * column + corner[0], 2 * row + corner[1], k)

            one = [at(c, 0) for c in CORNERS] + [at(c, 2) for c in CORNERS]
            if quadratic:
                one += [at(m, 0) for m in MIDDLES] + [at(m, 2) for m in MIDDLES]
                one += [at(c, 1) for c in CORNERS]
            elements.append(one)
    return nodes, elements


def set_of(name, numbers):
    lines = [
        ", ".join(map(str, numbers[i : i + 12])) for i in range(0, len(numbers), 12)
    ]
    return f"*NSET, NSET={name}\n" + ",\n".join(lines) + "\n"


def deck(element, n, depth, increment):
    """The text of an input file.

    element    CalculiX's name, e.g. C3D20R
    n          bricks along B
    depth      punch displacement at the end [m]
    increment  largest increment over the depth
    """
    nodes, elements = bricks(n, element.startswith("C3D20"))

    def where(test):
        return [i + 1 for i, x in enumerate(nodes) if test(*x)]

    sets = {
        "ALLNODES": where(lambda x, y, z: True),
        "LEFT": where(lambda x, y, z: x < SMALL),
        "RIGHT": where(lambda x, y, z: x > WIDTH - SMALL),
        "BASE": where(lambda x, y, z: y < SMALL),
        "PUNCH": where(lambda x, y, z: y > HEIGHT - SMALL and x < HALF_BREADTH + SMALL),
    }
    sets["PROBE"] = sets["PUNCH"][:1]
    text = "*NODE, NSET=NALL\n"
    text += "".join(
        f"{i + 1}, {x:.9g}, {y:.9g}, {z:.9g}\n" for i, (x, y, z) in enumerate(nodes)
    )
    text += f"*ELEMENT, TYPE={element}, ELSET=BLOCK\n"
    for i, one in enumerate(elements):
        words = [str(w) for w in [i + 1] + one]
        text += ", ".join(words[:11])
        if len(words) > 11:
            text += ",\n" + ", ".join(words[11:])
        text += "\n"
    text += "".join(set_of(name, numbers) for name, numbers in sets.items())
    text += f"""*MATERIAL, NAME=METAL
*ELASTIC
2.6e6, 0.3
*PLASTIC
{YIELD_STRESS:g}, 0.
{YIELD_STRESS:g}, 100.
*SOLID SECTION, ELSET=BLOCK, MATERIAL=METAL
*BOUNDARY
ALLNODES, 3, 3
LEFT, 1, 1
RIGHT, 1, 1
BASE, 2, 2
PUNCH, 1, 1
*STEP, NLGEOM, INC=100000
*STATIC, SOLVER=SPOOLES
{increment:g}, 1., 1e-6, {increment:g}
*BOUNDARY
PUNCH, 2, 2, {-depth:g}
*NODE PRINT, NSET=PUNCH, TOTALS=ONLY
RF
*END STEP
"""
    return text


TOTAL = re.compile(
    r"total force \(fx,fy,fz\) for set PUNCH and time\s+(\S+)\s+(\S+)\s+(\S+)"
)


def read_forces(text, n, depth):
    """Penetration z/B and mean pressure over yield stress, from a .dat file."""
    thickness = 1.0 / n
    out = []
    for time, _, fy in TOTAL.findall(text):
        pressure = -float(fy) / (HALF_BREADTH * thickness)
        out.append((float(time) * depth, pressure / YIELD_STRESS))
    return out
