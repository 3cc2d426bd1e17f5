"""Result folders of panel programs (WAMIT, HAMS, Nemoh, Capytaine) as platforms."""
