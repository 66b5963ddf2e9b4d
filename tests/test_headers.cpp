// SPDX-License-Identifier: MIT
/// No test: the target that this belongs to precompiles the headers that most tests include.
int main() {}
