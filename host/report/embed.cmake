# Embeds the report's page and three.js (Debian: libjs-three, r111) into topple_report.
find_file(TOPPLE_THREE_JS three.min.js PATHS /usr/share/javascript/three/build /usr/share/javascript/three
          NO_DEFAULT_PATH)
find_file(TOPPLE_ORBIT_CONTROLS OrbitControls.js
          PATHS /usr/share/javascript/three/examples/js/controls NO_DEFAULT_PATH)
if(NOT TOPPLE_THREE_JS OR NOT TOPPLE_ORBIT_CONTROLS)
  message(FATAL_ERROR "three.js is missing: apt-get install libjs-three (or run ./dev setup)")
endif()
set(PAGE ${CMAKE_CURRENT_SOURCE_DIR}/report/page)
set(PAGE_SCRIPTS ${PAGE}/data.js ${PAGE}/words.js ${PAGE}/glossary.js ${PAGE}/place.js ${PAGE}/charts.js ${PAGE}/fragility.js
                 ${PAGE}/landscapes.js ${PAGE}/contacts.js ${PAGE}/shaders.js ${PAGE}/overlays.js ${PAGE}/view.js ${PAGE}/sight.js ${PAGE}/painter.js
                 ${PAGE}/corrections.js ${PAGE}/parts.js ${PAGE}/compare_scans.js ${PAGE}/compare_parses.js ${PAGE}/compare.js
                 ${PAGE}/tables.js ${PAGE}/risk.js ${PAGE}/furniture.js ${PAGE}/plan.js ${PAGE}/sheet.js ${PAGE}/follow.js ${PAGE}/main.js)
list(JOIN PAGE_SCRIPTS "," PAGE_SCRIPT_LIST)
set(PAGE_PARTS ${CMAKE_CURRENT_BINARY_DIR}/report/page_parts.cpp)
file(MAKE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/report)
add_custom_command(
  OUTPUT ${PAGE_PARTS}
  COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/report/embed_page.py ${PAGE_PARTS}
          html=${PAGE}/page.html style=${PAGE}/page.css script=${PAGE_SCRIPT_LIST}
          three=${TOPPLE_THREE_JS} controls=${TOPPLE_ORBIT_CONTROLS}
  DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/report/embed_page.py ${PAGE}/page.html ${PAGE}/page.css ${PAGE_SCRIPTS}
          ${TOPPLE_THREE_JS} ${TOPPLE_ORBIT_CONTROLS}
  COMMENT "Embedding the report's page"
  VERBATIM)
target_sources(topple_report PRIVATE ${PAGE_PARTS})
