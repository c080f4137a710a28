"""Problems: what is asked, as data; one file for each family."""
