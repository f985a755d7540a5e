# Makes constants of the fitted models, in topple_fitted.
set(MODEL_TABLES ${CMAKE_CURRENT_BINARY_DIR}/fitted/model_tables.cpp)
file(MAKE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/fitted)
set(MODELS shell=${CMAKE_CURRENT_SOURCE_DIR}/fitted/shell.model.json
           joint=${CMAKE_CURRENT_SOURCE_DIR}/fitted/joint.model.json
           whole=${CMAKE_CURRENT_SOURCE_DIR}/fitted/whole.model.json
           context=${CMAKE_CURRENT_SOURCE_DIR}/fitted/context.model.json)
add_custom_command(
  OUTPUT ${MODEL_TABLES}
  COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/fitted/embed_models.py ${MODEL_TABLES} ${MODELS}
  DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/fitted/embed_models.py ${CMAKE_CURRENT_SOURCE_DIR}/fitted/shell.model.json
          ${CMAKE_CURRENT_SOURCE_DIR}/fitted/joint.model.json ${CMAKE_CURRENT_SOURCE_DIR}/fitted/whole.model.json
          ${CMAKE_CURRENT_SOURCE_DIR}/fitted/context.model.json
  COMMENT "Embedding the fitted models"
  VERBATIM)
target_sources(topple_fitted PRIVATE ${MODEL_TABLES})
