// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/python/borders.h"

PYBIND11_MODULE(_artus, module) {
  module.doc() = "The engine of the package artus.";
  module.attr("__version__") = ARTUS_VERSION;
  artus::python::add_bodies(module);
  artus::python::add_images(module);
  artus::python::add_forces(module);
  artus::python::add_presses(module);
  artus::python::add_simulations(module);
  artus::python::add_injections(module);
  artus::python::add_assessments(module);
}
