/* SPDX-License-Identifier: MIT */
/* Nothing: a library that build scripts look for and that programs call nothing of. */
typedef int hapticd_stub_of_hdapi;
