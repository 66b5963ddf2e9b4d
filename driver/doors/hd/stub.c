/* SPDX-License-Identifier: MIT */
/* Empty on purpose: build scripts need a library of this name, but programs call no function of it. */
typedef int hapticd_stub_of_hdapi;
