# Run by cpack before it packs: `mjarm` in /usr/bin.
file(MAKE_DIRECTORY "${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/bin")
file(CREATE_LINK "/opt/mjarm/bin/mjarm" "${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/bin/mjarm" SYMBOLIC)
