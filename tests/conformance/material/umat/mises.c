/* SPDX-License-Identifier: LGPL-3.0-or-later */
/* Von Mises with linear hardening: radial return and its consistent tangent.
 * PROPS: Young's modulus, Poisson's ratio, yield stress in tension, its slope
 * over the plastic strain. STATEV(1): plastic strain. */
#include "umat.h"
#include <math.h>

void umat_(UMAT_ARGUMENTS)
{
  const int n = *ntens;
  const double G = props[0] / (2 * (1 + props[1]));
  const double K = props[0] / (3 * (1 - 2 * props[1]));
  const double yield = props[2] + props[3] * statev[0];
  double trial[6], normal[6], mean = 0, square = 0;
  const double volume = dstran[0] + dstran[1] + dstran[2];
  for (int i = 0; i < 3; ++i)
    mean += stress[i] / 3;
  for (int i = 0; i < n; ++i)
  {
    trial[i] = i < 3 ? stress[i] - mean + 2 * G * (dstran[i] - volume / 3)
                     : stress[i] + G * dstran[i];
    square += (i < 3 ? 1 : 2) * trial[i] * trial[i];
  }
  mean += K * volume;
  const double mises = sqrt(1.5 * square);
  double keep = 1, slope = 0; /* of the trial's size, and of its own slope */
  if (mises > yield)
  {
    const double plastic = (mises - yield) / (3 * G + props[3]);
    statev[0] += plastic;
    keep = (props[2] + props[3] * statev[0]) / mises;
    slope = props[3] / (3 * G + props[3]) - keep;
  }
  for (int i = 0; i < n; ++i)
  {
    normal[i] = square > 0 ? trial[i] / sqrt(square) : 0;
    stress[i] = keep * trial[i] + (i < 3 ? mean : 0);
  }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      ddsdde[i + n * j] = (i < 3 && j < 3 ? K - keep * 2 * G / 3 : 0)
                          + (i == j ? keep * (i < 3 ? 2 * G : G) : 0)
                          + slope * 2 * G * normal[i] * normal[j];
}
