# SPDX-License-Identifier: MIT
# Takes the scenes out of a list that `hapticd tune --write` has put beside the shipped ones. Their tests would have the
# names of those of the shipped scenes, and CMake refuses two tests of one name.
macro(hapticd_drop_tuned_scenes scenes)
  list(FILTER ${scenes} EXCLUDE REGEX "[.]tuned[.]yaml$")
endmacro()
