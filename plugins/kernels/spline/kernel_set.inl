// The kernels of one translation unit. See kernel_common.inl for the rules of this file.
#define HAPTICD_TABLE_KERNELS(U, V)                                   \
  {                                                                   \
    {evaluateTable<U, V, false, 1>, evaluateTable<U, V, false, 2>}, { \
      evaluateTable<U, V, true, 1>, evaluateTable<U, V, true, 2>      \
    }                                                                 \
  }

namespace {

constexpr KernelSet kKernels = {
    {{evaluateNet<Weights::kNone, 1>, evaluateNet<Weights::kNone, 2>},
     {evaluateNet<Weights::kMild, 1>, evaluateNet<Weights::kMild, 2>},
     {evaluateNet<Weights::kSevere, 1>, evaluateNet<Weights::kSevere, 2>}},
    {HAPTICD_TABLE_KERNELS(4, 1), HAPTICD_TABLE_KERNELS(6, 1), HAPTICD_TABLE_KERNELS(2, 2), HAPTICD_TABLE_KERNELS(2, 3),
     HAPTICD_TABLE_KERNELS(3, 2), HAPTICD_TABLE_KERNELS(3, 3), HAPTICD_TABLE_KERNELS(4, 2), HAPTICD_TABLE_KERNELS(2, 4),
     HAPTICD_TABLE_KERNELS(4, 4), HAPTICD_TABLE_KERNELS(6, 2), HAPTICD_TABLE_KERNELS(2, 6), HAPTICD_TABLE_KERNELS(6, 6),
     HAPTICD_TABLE_KERNELS(0, 0)}};

}  // namespace

#undef HAPTICD_TABLE_KERNELS
