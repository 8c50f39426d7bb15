"""Operations, selection and vertex drags by mouse, keys and menus."""
