/* SPDX-License-Identifier: LGPL-3.0-or-later */
/* A library without the symbol. */
void umat(void) {}
