# SPDX-License-Identifier: AGPL-3.0-or-later
# scripts/package makes a package of Debian of the component `program` and the Python module.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME artus)
set(CPACK_PACKAGE_CONTACT "The developers of artus <developers@artus.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program python_debian)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "fonts-dejavu-core, libgl1-mesa-dri")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3, python3-numpy")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "trainer of ultrasound-guided joint injection")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"A mesh-based layered body of a joint gives the force on needle and probe, the
ultrasound image and the spread of what is injected, from one model: the tool
artus, its trainer, bundled joints and scenarios, and the module for Python.

Not a medical device: for training and research. It must not be used to plan,
guide or assess the treatment of a patient.

Licence: AGPL-3.0-or-later.")
include(CPack)
