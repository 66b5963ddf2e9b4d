// SPDX-License-Identifier: MIT
/// For a shape plugin in C++: derive from hapticd::Shape, list the parameters, write activate() and touch() (or
/// step()), name the class in HAPTICD_SHAPES(...). shape.h says what each call must do; plugins/template is an example.
#pragma once
#include <span>

#include "parameters.hpp"
#include "shape.h"

namespace hapticd {

/// Describes a class before any instance exists. All texts have static storage.
struct ShapeInfo {
  const char* id;    ///< reverse DNS, "org.example.shape.sphere"
  const char* name;  ///< name of the class in scenes, "sphere"
  const char* version;
  const char* license;
  const char* doc;     ///< one or two sentences
  uint32_t flags = 0;  ///< HSP_C_*
};

/// [main] Returns the force [N] up to which a claimed stiffness must hold: the largest force that any arm of the scene
/// lets through to the hand. @param activation the argument of activate() @param unknown [N] returned if the host does
/// not give that force
inline double forceToClaimFor(const hsp_activation& activation, double unknown) {
  return HSP_HAS(&activation, max_arm_force) && activation.max_arm_force > 0 ? activation.max_arm_force : unknown;
}

/// [main] Reports that the force jumps on purpose, by at most `newtons` [N]. Has no effect if the host is too old to
/// read max_jump.
inline void reportJumps(hsp_report& report, double newtons) {
  if (!HSP_HAS(&report, max_jump)) return;
  report.flags |= HSP_R_JUMPS;
  report.max_jump = newtons;
}

/// [any] Returns the index of a probe in its step, which is below hsp_activation::max_probes.
inline uint32_t indexOf(const hsp_probe& probe, const hsp_step& step) noexcept HSP_RT {
  const auto bytes = reinterpret_cast<const char*>(&probe) - reinterpret_cast<const char*>(step.in);
  return step.in_stride == 0 ? 0 : static_cast<uint32_t>(bytes / static_cast<ptrdiff_t>(step.in_stride));
}

/// [rt] Calls `touch(probe, contact, index)` for each probe of a step. Returns the status for the whole step: the first
/// failure, or HSP_DEGRADED if an answer is coarser than asked.
template <class Touch>
hsp_status touchEach(const hsp_step& step, const Touch& touch) noexcept HSP_RT {
  hsp_status worst = HSP_OK;
  for (uint32_t i = 0; i < step.count; ++i) {
    const hsp_status status = touch(*HSP_AT(const hsp_probe, step.in, step.in_stride, i),
                                    *HSP_AT(hsp_contact, step.out, step.out_stride, i), i);
    if (status < 0 ? worst >= 0 : worst == HSP_OK) worst = status;
  }
  return worst;
}

/// Base class of shapes. The host creates and destroys instances. A derived class T has
///   static constexpr ShapeInfo kInfo;
///   static constexpr auto fields();                            std::array<Field<T>, N>, one line per parameter
///   void activate(const hsp_activation&, hsp_report&);         [main] may allocate and throw
/// and one of
///   hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact&) noexcept HSP_RT;   [rt] answers one probe
///   hsp_status step(const hsp_step&) noexcept HSP_RT;                                    [rt] answers all probes
/// (one that has both is asked by step() alone, which may call touch()), and may hide the functions below. The text of
/// an exception becomes the error that the user reads.
class Shape {
 public:
  void deactivate() {}                                             ///< [main] frees what activate() took
  void reset() noexcept HSP_RT {}                                  ///< [rt] forgets the foot points that it follows
  const void* extension(const char* /*name*/) { return nullptr; }  ///< [main] nullptr if it has none of that name
  void changed() noexcept HSP_RT {}               ///< [rt] called when live parameters have new values, before step()
  const hsp_host* host() const { return host_; }  ///< [any] not valid in the constructor
  /// [main][sim] Writes a text to the log of the host, if there is one. The level is HSP_LOG_WARNING or the like.
  void writeLog(int32_t level, const std::string& text) const { detail::writeLog(host_, level, text); }

 private:
  template <class T>
  friend struct ShapeClass;
  const hsp_host* host_ = nullptr;
  bool active_ = false;
};

/// Makes the C functions of class T, and its description as constant data. A call in a wrong state returns HSP_E_STATE.
template <class T>
struct ShapeClass {
  static constexpr auto kFields = T::fields();
  static constexpr auto kParams = detail::tableOf(kFields);

  static T& self(hsp_shape* shape) { return *reinterpret_cast<T*>(shape); }

  static hsp_shape* create(const hsp_class*, const hsp_host* host) {
    T* object = detail::make(host, kFields);
    if (object != nullptr) static_cast<Shape*>(object)->host_ = host;
    return reinterpret_cast<hsp_shape*>(object);
  }
  static void destroy(hsp_shape* shape) { delete &self(shape); }

  static hsp_status set(hsp_shape* shape, uint32_t param, const hsp_value* value) {
    if (base(shape).active_) return HSP_E_STATE;
    return detail::assign(self(shape), kFields, base(shape).host_, param, value);
  }
  static hsp_status get(hsp_shape* shape, uint32_t param, hsp_value* value) {
    return detail::fetch(self(shape), kFields, param, value);
  }

  static hsp_status activate(hsp_shape* shape, const hsp_activation* activation, hsp_report* report) {
    if (base(shape).active_) return HSP_E_STATE;
    return detail::guarded(base(shape).host_, "", "activate()", HSP_E_ARG, [&] {
      self(shape).activate(*activation, *report);
      base(shape).active_ = true;
    });
  }
  static void deactivate(hsp_shape* shape) {
    if (base(shape).active_) self(shape).deactivate();
    base(shape).active_ = false;
  }
  static void reset(hsp_shape* shape) noexcept HSP_RT { self(shape).reset(); }

  static hsp_status step(hsp_shape* shape, const hsp_step* step) noexcept HSP_RT {
    if (!base(shape).active_) return HSP_E_STATE;
    applyChanges(self(shape), *step);
    if constexpr (requires(T& t) { t.step(*step); }) {
      return self(shape).step(*step);
    } else {
      static_assert(
          requires(T& t, const hsp_probe& probe, hsp_contact& contact) { t.touch(probe, *step, contact); },
          "the shape has neither hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact&) noexcept nor "
          "hsp_status step(const hsp_step&) noexcept; "
          "check the name and the arguments of the function, and that it is public");
      return touchEach(*step, [&](const hsp_probe& probe, hsp_contact& contact, uint32_t)
                                  HSP_RT { return self(shape).touch(probe, *step, contact); });
    }
  }
  static const void* extension(hsp_shape* shape, const char* name) { return self(shape).extension(name); }

  static constexpr hsp_class kClass = {sizeof(hsp_class),
                                       static_cast<uint32_t>(kParams.size()),
                                       T::kInfo.flags,
                                       0,
                                       T::kInfo.id,
                                       T::kInfo.name,
                                       T::kInfo.version,
                                       T::kInfo.license,
                                       T::kInfo.doc,
                                       kParams.data(),
                                       &create,
                                       &destroy,
                                       &set,
                                       &get,
                                       &activate,
                                       &deactivate,
                                       &reset,
                                       &step,
                                       &extension};

 private:
  static Shape& base(hsp_shape* shape) { return self(shape); }

  static void applyChanges(T& object, const hsp_step& step) noexcept HSP_RT {
    if (step.change_count == 0) return;
    for (uint32_t i = 0; i < step.change_count; ++i) {
      const hsp_change& change = step.changes[i];
      if (change.param >= kFields.size()) continue;
      const Field<T>& field = kFields[change.param];
      if ((field.param.flags & HSP_P_LIVE) != 0 && detail::inRange(field.param, change.value))
        detail::assignNumber(object, field, change.value);
    }
    object.changed();
  }
};

namespace detail {
template <class... T>
inline constexpr std::array<const hsp_class*, sizeof...(T)> kShapeClasses = {&ShapeClass<T>::kClass...};
}

}  // namespace hapticd

/// Exports the shapes of this plugin. Use it once per shared object, at file scope: HAPTICD_SHAPES(Sphere, Box)
#define HAPTICD_SHAPES(...)                                                                            \
  extern "C" {                                                                                         \
  constinit const hsp_entry hsp_plugin_entry = {HSP_MAGIC, HSP_ABI_MAJOR, HSP_ABI_MINOR,               \
                                                ::hapticd::detail::kShapeClasses<__VA_ARGS__>.size(),  \
                                                ::hapticd::detail::kShapeClasses<__VA_ARGS__>.data()}; \
  }
