/* SPDX-License-Identifier: LGPL-3.0-or-later */
/* Hooke's law with G = K = PROPS(1) that misbehaves as PROPS(2) says:
 * 1: PNEWDT = 0.25 where a strain exceeds PROPS(3); 2: NaN stress there;
 * 3: infinite tangent there; 4: NaN state there; 5: no tangent at all;
 * 6: writes into its input. It writes down what it was called with:
 * STATEV = STRAN(1..4), TIME(1), TIME(2), DTIME, KINC, DFGRD1(1,2). */
#include "umat.h"
#include <math.h>

void umat_(UMAT_ARGUMENTS)
{
  const double G = props[0];
  const int mode = (int)props[1];
  double largest = 0;
  for (int i = 0; i < 4; ++i)
    largest = fmax(largest, fabs(dstran[i]));
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      ddsdde[i + 4 * j] = (i < 3 && j < 3 ? G / 3 : 0)
                          + (i == j ? (i < 3 ? 2 * G : G) : 0);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      stress[i] += ddsdde[i + 4 * j] * dstran[j];
  if (*nstatv == 9)
  {
    for (int i = 0; i < 4; ++i)
      statev[i] = stran[i];
    statev[4] = time[0];
    statev[5] = time[1];
    statev[6] = *dtime;
    statev[7] = *kinc;
    statev[8] = dfgrd1[3];
  }
  const int much = largest > props[2];
  if (mode == 1 && much)
    *pnewdt = 0.25;
  if (mode == 2 && much)
    stress[1] = NAN;
  if (mode == 3 && much)
    ddsdde[5] = INFINITY;
  if (mode == 4 && much)
    statev[0] = NAN;
  if (mode == 5)
    for (int i = 0; i < 16; ++i)
      ddsdde[i] = 0;
  if (mode == 6)
  {
    ((double *)props)[0] = 0;
    ((double *)dstran)[0] = 1;
  }
}
