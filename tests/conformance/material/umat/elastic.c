/* SPDX-License-Identifier: LGPL-3.0-or-later */
/* Hooke's law. PROPS: Young's modulus, Poisson's ratio. */
#include "umat.h"

void umat_(UMAT_ARGUMENTS)
{
  const int n = *ntens;
  const double G = props[0] / (2 * (1 + props[1]));
  const double lambda = 2 * G * props[1] / (1 - 2 * props[1]);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      ddsdde[i + n * j] = (i < *ndi && j < *ndi ? lambda : 0)
                          + (i == j ? (i < *ndi ? 2 * G : G) : 0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      stress[i] += ddsdde[i + n * j] * dstran[j];
}
